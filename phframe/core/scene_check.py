"""What makes a scene impossible, in sentences for people."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, combinations, islice

from phframe.core.names import name_fault, name_shown
from phframe.core.scene_limits import (
    FARTHEST,
    FRICTION,
    LENGTH,
    MASS,
    MOST_OBJECTS,
    MOST_PROBLEMS,
    MOST_TURNED,
    at_most,
    not_negative,
    positive,
)
from phframe.core.shelf import BasePose, SceneObject, Shelf

CONTACT_TOLERANCE = 1e-3
"""Less than this much (m) into each other counts as touching: for objects, walls and ceiling. Engines leave what lies still
in contact up to 0.4 mm into one another, and what they leave is a scene again."""


def problems_of(
    name: str, shelf: Shelf, objects: Sequence[SceneObject], target: str, base_poses: Mapping[str, BasePose]
) -> list[str]:
    """What is wrong with what is to be a scene, one sentence each; geometry only where the figures are sound.

    Args:
        name: Of the scene.
        shelf: The shelf.
        objects: All objects.
        target: The id of the one to take out.
        base_poses: Where arms' bases stand, by the arms' names.

    Returns:
        The first of them, and that there are more.
    """
    if len(objects) > MOST_OBJECTS:
        return [f"it has {len(objects)} objects; at most {MOST_OBJECTS} are planned with, since every two are compared"]
    figures = chain(_bad_shelf(shelf), *map(_bad_object, objects), _bad_base_poses(base_poses))
    names = chain(_bad_names(name, objects, base_poses), _bad_ids([item.id for item in objects], target))
    return _first(chain(figures, names)) or _first(chain(_outside(shelf, objects), _overlapping(objects)))


def _first(problems: Iterator[str]) -> list[str]:
    """The first problems; of thousands the others are not even looked for."""
    first = list(islice(problems, MOST_PROBLEMS + 1))
    return [*first[:MOST_PROBLEMS], "and more"] if len(first) > MOST_PROBLEMS else first


def _bad_shelf(shelf: Shelf) -> Iterator[str]:
    for name in ("depth", "width", "height"):
        yield from positive(f"shelf {name}", getattr(shelf, name), LENGTH)
    for name in ("board_friction", "wall_friction"):
        yield from not_negative(f"shelf {name}", getattr(shelf, name), FRICTION)


def base_pose_faults(owner: str, base_pose: BasePose) -> Iterator[str]:
    """What is wrong with where an arm's base stands, in sentences that begin with whose it is."""
    for axis in ("x", "y", "z"):
        yield from at_most(f"{owner}: {axis}", getattr(base_pose, axis), FARTHEST, "distances (m)")
    yield from at_most(f"{owner}: yaw", base_pose.yaw, MOST_TURNED, "headings (rad)")


def _bad_base_poses(base_poses: Mapping[str, BasePose]) -> Iterator[str]:
    for name, base_pose in base_poses.items():
        yield from base_pose_faults(f"base pose of {name_shown(name)}", base_pose)


def _bad_object(item: SceneObject) -> Iterator[str]:
    owner = f"object {name_shown(item.id)}"
    for name, figure in item.shape.figures().items():
        yield from positive(f"{owner}: {name}", figure, LENGTH)
    yield from positive(f"{owner}: mass", item.mass, MASS)
    yield from not_negative(f"{owner}: friction", item.friction or 0.0, FRICTION)
    for name, number in zip(("x", "y"), item.position, strict=True):
        yield from at_most(f"{owner}: {name}", number, math.inf, "")
    yield from at_most(f"{owner}: yaw", item.yaw, MOST_TURNED, "headings (rad)")


def _bad_names(name: str, objects: Sequence[SceneObject], base_poses: Mapping[str, BasePose]) -> Iterator[str]:
    for what, each in (("name", name), *(("id", item.id) for item in objects), *(("arm", arm) for arm in base_poses)):
        if fault := name_fault(each):
            yield f"the {what} {name_shown(each)} {fault}"


def _bad_ids(ids: Sequence[str], target: str) -> Iterator[str]:
    for name, count in Counter(ids).items():
        if count > 1:
            yield f"the id {name_shown(name)} is used {count} times; ids must be unique"
    if target not in ids:
        yield f"the target {name_shown(target)} is not among the objects: {_listed(ids)}"


def _listed(ids: Sequence[str]) -> str:
    more = len(ids) - MOST_PROBLEMS
    shown = (name_shown(each) if name_fault(each) else each for each in ids[:MOST_PROBLEMS])
    return (", ".join(shown) + (f" and {more} more" if more > 0 else "")) or "there are none"


def _outside(shelf: Shelf, objects: Sequence[SceneObject]) -> Iterator[str]:
    for item in objects:
        for place, excess in _excess(shelf, item):
            if excess > CONTACT_TOLERANCE:
                yield f"object {item.id!r} is {excess * 1e3:.1f} mm {place}"
        if item.shape.height > shelf.height + CONTACT_TOLERANCE:
            yield f"object {item.id!r} is {item.shape.height:g} m tall; the shelf is {shelf.height:g} m high"


def _excess(shelf: Shelf, item: SceneObject) -> Iterator[tuple[str, float]]:
    (x, y), r = item.position, item.radius
    yield "inside the south wall", r - y
    yield "inside the north wall", y + r - shelf.width
    yield "inside the back wall", x + r - shelf.depth
    yield "outside the mouth with its centre", -x


def _overlapping(objects: Sequence[SceneObject]) -> Iterator[str]:
    for a, b in combinations(objects, 2):
        depth = a.radius + b.radius - math.dist(a.position, b.position)
        if depth > CONTACT_TOLERANCE:
            yield f"objects {a.id!r} and {b.id!r} overlap by {depth * 1e3:.1f} mm"
