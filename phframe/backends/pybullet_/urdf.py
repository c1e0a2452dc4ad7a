"""Makes an arm's URDF fit for PyBullet, which names links but not their shapes, and passes over coupled joints."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from phframe.core import ArmModel, IncompatibleError, InputError
from phframe.urdf.convex_hull import ConvexHull
from phframe.urdf.model import CollisionGeometry, Link, Mimic, Robot, RobotJoint
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import ORIGIN, Inertia
from phframe.urdf.writer import robot_urdf

WEIGHTLESS = Inertia(0.0, ORIGIN, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@dataclass(frozen=True, slots=True)
class PreparedUrdf:
    """An arm as PyBullet can have it.

    Attributes:
        text: The URDF: nothing to look at, one link for every part that has an outline.
        parts: What each link is called in a contact.
        couplings: What joints follow, by their names.
        files: Contents of the files of convex hulls, by the names that they have in the text.
    """

    text: str
    parts: dict[str, str]
    couplings: Mapping[str, Mimic]
    files: Mapping[str, bytes] = field(default_factory=dict)


def prepared_urdf(arm: ArmModel[Any]) -> PreparedUrdf:
    """The URDF of an arm, ready to load.

    Raises:
        IncompatibleError: If it cannot be read, or lacks a joint or link that the arm names.
    """
    try:
        robot = read_robot(arm.urdf())
    except InputError as error:
        raise IncompatibleError(f"PyBullet cannot load the URDF of {type(arm).__name__}: {error}") from None
    _refuse_lacking(arm, robot)
    outlined = {outline.part for outline in arm.shape.closed}
    pieces = [piece for link in robot.links.values() for piece in _pieces(link, outlined)]
    files: dict[str, bytes] = {}
    links = [_with_hull_files(link, files) for link, _, _ in sorted(pieces, key=lambda piece: piece[2] is not None)]
    shells = [joint for _, _, joint in pieces if joint is not None]
    split = Robot.of(robot.name, links, [*robot.parent_joints.values(), *shells])
    couplings = {name: joint.mimic for name, joint in robot.moving.items() if joint.mimic}
    return PreparedUrdf(robot_urdf(split), {link.name: part for link, part, _ in pieces}, couplings, files)


def _refuse_lacking(arm: ArmModel[Any], robot: Robot) -> None:
    wanted = [joint.name for joint in (*arm.joints, *arm.fingers.joints)]
    wanted += [joint.mimic.joint for joint in robot.moving.values() if joint.mimic]
    lacking = [name for name in wanted if name not in robot.moving]
    lacking += [name for name in (arm.tip_link, *arm.fingers.links) if name not in robot.links]
    if lacking:
        raise IncompatibleError(f"the URDF of {type(arm).__name__} has no joint or link {', '.join(lacking)}")


def _pieces(link: Link, outlined: Container[str]) -> Iterator[tuple[Link, str, RobotJoint | None]]:
    """What a link is taken apart into, what each piece is called, as its outline or as the link, and how it hangs on."""
    named = [(shape.name or f"{link.name} {shape.part}", shape) for shape in link.collision_geometry]
    shells = [(part, shape) for part, shape in named if part in outlined] if len(named) != 1 else []
    rest = tuple(shape for part, shape in named if not shells or part not in outlined)
    yield (
        replace(link, visuals=(), collision_geometry=rest),
        named[0][0] if len(named) == 1 and named[0][0] in outlined else link.name,
        None,
    )
    for part, shape in shells:
        name = f"{link.name}/{part}"
        yield Link(name, WEIGHTLESS, (shape,)), part, RobotJoint(link.name, name, fixed_name=f"{name} mount")


def _with_hull_files(link: Link, files: dict[str, bytes]) -> Link:
    """The link with its convex hulls in files beside the text, whose contents are added."""
    return replace(link, collision_geometry=tuple(_in_file(shape, files) for shape in link.collision_geometry))


def _in_file(shape: CollisionGeometry, files: dict[str, bytes]) -> CollisionGeometry:
    if not isinstance(shape, ConvexHull):
        return shape
    name = f"hull_{len(files)}.obj"
    files[name] = shape.wavefront()
    return replace(shape, file=name, scale=(1.0, 1.0, 1.0))
