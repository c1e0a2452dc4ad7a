"""A robot as a kinematic tree of rigid links: inertia, collision geometry, visuals, joints, limits and mimic couplings."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from phframe.core import ArmError, FloatArray, Joint
from phframe.urdf.convex_hull import ConvexHull
from phframe.urdf.solids import ORIGIN, Inertia, Solid, Vector, axis_rotation, roll_pitch_yaw, rotation
from phframe.yaml.wording import shown

MOST_LISTED = 20
"""Names in one message."""
CollisionGeometry = Solid | ConvexHull
Color = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class MeshFile:
    """A mesh that is only looked at: where its file is, unread.

    Attributes:
        file: Its path, or what the URDF has where it was not found.
        scale: By which its coordinates are multiplied.
        at: Origin of the file in the frame of the link (m).
        rpy: Rotation there (rad), about the fixed axes x, y, z.
    """

    file: str
    scale: Vector = (1.0, 1.0, 1.0)
    at: Vector = ORIGIN
    rpy: Vector = ORIGIN


@dataclass(frozen=True, slots=True)
class Visual:
    """What is seen of a link.

    Attributes:
        shape: A primitive, or a file.
        color: Red, green, blue and opacity, from 0 to 1; None: not said.
    """

    shape: Solid | MeshFile
    color: Color | None = None


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid part.

    Attributes:
        name: Unique in the robot.
        inertia: Of all of it; None: not said.
        collision_geometry: What collides.
        visuals: What is seen.
        friction: Coefficient that PyBullet takes for it; None: not said.
    """

    name: str
    inertia: Inertia | None = None
    collision_geometry: tuple[CollisionGeometry, ...] = ()
    visuals: tuple[Visual, ...] = ()
    friction: float | None = None

    @classmethod
    def of_solids(
        cls, name: str, inertia: Inertia, solids: Iterable[Solid] = (), color: Color | None = None, **more: float
    ) -> Link:
        """A link that is seen as what collides."""
        own = tuple(solids)
        return cls(name, inertia, own, tuple(Visual(solid, color) for solid in own), **more)


@dataclass(frozen=True, slots=True)
class Mimic:
    """The coupling of a joint to another: ``value = multiplier * leader + offset``.

    Attributes:
        joint: Name of the leader.
        multiplier: Of the leader's value.
        offset: Where the leader is at 0 (rad or m).
    """

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def after(self, other: Mimic) -> Mimic:
        """The coupling to the leader of one's leader."""
        return Mimic(other.joint, self.multiplier * other.multiplier, self.multiplier * other.offset + self.offset)


@dataclass(frozen=True, slots=True)
class RobotJoint:
    """How one link hangs on another.

    Attributes:
        parent: Name of the link it hangs on.
        child: Name of the link it carries.
        at: Origin of the child's frame in the parent's at joint value 0 (m).
        rpy: Rotation there (rad), about the fixed axes x, y, z.
        joint: What moves, and its limits, 0 where the URDF gives none; None: the links are fixed to one another.
        kind: Whether it turns, turns without end, or slides.
        axis: Unit vector about or along which it does, in the child's frame.
        mimic: What it follows; None: nothing.
        damping: Viscous friction (Nms/rad or Ns/m).
        friction: Dry friction (Nm or N).
        fixed_name: Of a fixed joint; empty: the child's, with ``_mount``.
    """

    parent: str
    child: str
    at: Vector = ORIGIN
    rpy: Vector = ORIGIN
    joint: Joint | None = None
    kind: Literal["revolute", "continuous", "prismatic"] = "revolute"
    axis: Vector = (0.0, 0.0, 1.0)
    mimic: Mimic | None = None
    damping: float = 0.0
    friction: float = 0.0
    fixed_name: str = ""

    @property
    def name(self) -> str:
        """Unique among the robot's joints."""
        return self.joint.name if self.joint else self.fixed_name or f"{self.child}_mount"

    def placement(self, value: float = 0.0) -> FloatArray:
        """Homogeneous transform ``(4, 4)`` of the child's frame in the parent's at a joint value (rad or m)."""
        place, axes = np.eye(4), rotation(self.rpy)
        place[:3, :3], place[:3, 3] = axes, self.at
        if self.joint is not None and self.kind == "prismatic":
            place[:3, 3] += axes @ np.asarray(self.axis) * value
        elif self.joint is not None:
            place[:3, :3] = axes @ axis_rotation(self.axis, value)
        return place

    def fixed_at(self, value: float) -> RobotJoint:
        """The same links, fixed to one another as they are at a joint value (rad or m)."""
        place = self.placement(value)
        x, y, z = place[:3, 3].tolist()
        return RobotJoint(self.parent, self.child, (x, y, z), roll_pitch_yaw(place[:3, :3]), fixed_name=self.name)

    def reversed(self) -> RobotJoint:
        """The same motion with the sign of the joint value changed."""
        joint = self.joint and replace(self.joint, lower=0.0 - self.joint.upper, upper=0.0 - self.joint.lower)
        x, y, z = (0.0 - along for along in self.axis)
        mimic = self.mimic and replace(self.mimic, multiplier=-self.mimic.multiplier, offset=0.0 - self.mimic.offset)
        return replace(self, joint=joint, axis=(x, y, z), mimic=mimic)


@dataclass(frozen=True)
class Robot:
    """Links that hang together as one tree.

    Attributes:
        name: Of the robot.
        links: By name, as they stand in the URDF.
        parent_joints: What each link but the root hangs on, by that link.
    """

    name: str
    links: Mapping[str, Link]
    parent_joints: Mapping[str, RobotJoint] = field(default_factory=dict)

    @classmethod
    def of(cls, name: str, links: Iterable[Link], joints: Iterable[RobotJoint] = ()) -> Robot:
        """The robot of these links and joints.

        Raises:
            ArmError: If they do not make one tree.
        """
        parts, hung = tuple(links), tuple(joints)
        robot = cls(name, {link.name: link for link in parts}, {joint.child: joint for joint in hung})
        for twice in _twice([link.name for link in parts], "link"), _twice([joint.name for joint in hung], "joint"):
            if twice:
                raise ArmError(f"the URDF has more than one {twice}")
        robot._check_tree(hung)
        return robot

    @property
    def root(self) -> str:
        """The link that hangs on no joint."""
        return next(name for name in self.links if name not in self.parent_joints)

    @cached_property
    def collision_geometry(self) -> Mapping[str, tuple[CollisionGeometry, ...]]:
        """What collides, by link."""
        return {name: link.collision_geometry for name, link in self.links.items()}

    @cached_property
    def moving(self) -> Mapping[str, RobotJoint]:
        """The joints that are not fixed, by their names."""
        return {each.name: each for each in self.parent_joints.values() if each.joint is not None}

    @cached_property
    def from_root(self) -> tuple[RobotJoint, ...]:
        """All joints, those of parents before those of their children."""
        found: list[RobotJoint] = []
        reached = [self.root]
        for parent in reached:
            carried = [joint for joint in self.parent_joints.values() if joint.parent == parent]
            found += carried
            reached += [joint.child for joint in carried]
        return tuple(found)

    def joint(self, name: str) -> RobotJoint:
        """The joint that bears a name.

        Raises:
            ArmError: If no joint that moves is called so.
        """
        if name not in self.moving:
            raise ArmError(f"the URDF has no moving joint {shown(name)}; there is: {listed(sorted(self.moving))}")
        return self.moving[name]

    def with_joints(self, joints: Iterable[RobotJoint]) -> Robot:
        """The robot with some of its joints replaced."""
        return replace(self, parent_joints={**self.parent_joints, **{joint.child: joint for joint in joints}})

    def with_frame(self, name: str, parent: str, at: Vector, rpy: Vector) -> Robot:
        """The robot with a further link that is a mere frame; it weighs next to nothing, as engines want."""
        speck = Inertia(1e-4, ORIGIN, (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8))
        frame = RobotJoint(parent, name, at, rpy)
        return Robot.of(self.name, [*self.links.values(), Link(name, speck)], [*self.parent_joints.values(), frame])

    def without_hulls(self) -> Robot:
        """The robot with primitives alone, for engines that are given convex hulls by other means than files."""
        return replace(
            self,
            links={
                name: replace(
                    link,
                    visuals=(),
                    collision_geometry=tuple(solid for solid in link.collision_geometry if isinstance(solid, Solid)),
                )
                for name, link in self.links.items()
            },
        )

    @property
    def hulls(self) -> tuple[tuple[str, ConvexHull], ...]:
        """Every convex hull with the name of its link."""
        return tuple(
            (name, shape)
            for name, shapes in self.collision_geometry.items()
            for shape in shapes
            if isinstance(shape, ConvexHull)
        )

    def _check_tree(self, joints: tuple[RobotJoint, ...]) -> None:
        for joint in joints:
            for link in (joint.parent, joint.child):
                if link not in self.links:
                    raise ArmError(f"a joint of the URDF names the link {shown(link)}, which does not exist")
        roots = [link for link in self.links if link not in self.parent_joints]
        if len(roots) != 1 or len(joints) != len(self.parent_joints) or len(self.from_root) != len(joints):
            raise ArmError(f"the links of the URDF must make one tree; without a parent: {listed(roots)}")


def listed(names: Collection[str]) -> str:
    """Names in a message: the first of them, and how many more there are."""
    first = ", ".join(list(names)[:MOST_LISTED]) or "none"
    return first if len(names) <= MOST_LISTED else f"{first} and {len(names) - MOST_LISTED} more"


def _twice(names: list[str], what: str) -> str:
    return next((f"{what} {name!r}" for name in names if names.count(name) > 1), "")
