"""What makes a scene impossible, in sentences for people."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from phframe.core.shelf import BasePose, SceneObject, Shelf

CONTACT_TOLERANCE = 1e-6
"""Objects may touch; less than this much (m) into each other counts as touching."""


def problems_of(
    shelf: Shelf, objects: Sequence[SceneObject], target: str, base_poses: Mapping[str, BasePose]
) -> list[str]:
    """Everything wrong with what is to be a scene, one sentence each; geometry only where the figures are sound.

    Args:
        shelf: The shelf.
        objects: All objects.
        target: The id of the one to take out.
        base_poses: Where arms' bases stand, by the arms' names.
    """
    figures = [*_bad_shelf(shelf), *(fault for item in objects for fault in _bad_object(item))]
    problems = [*figures, *_bad_base_poses(base_poses), *_bad_ids([item.id for item in objects], target)]
    return problems or [*_outside(shelf, objects), *_overlapping(objects)]


def _bad_shelf(shelf: Shelf) -> Iterator[str]:
    for name in ("depth", "width", "height"):
        yield from _not_positive(f"shelf {name}", getattr(shelf, name))
    for name in ("board_friction", "wall_friction"):
        yield from _negative(f"shelf {name}", getattr(shelf, name))


def _bad_base_poses(base_poses: Mapping[str, BasePose]) -> Iterator[str]:
    for name, base_pose in base_poses.items():
        if not all(math.isfinite(number) for number in (base_pose.x, base_pose.y, base_pose.z, base_pose.yaw)):
            yield f"base pose of {name!r}: {base_pose} holds a number that is not finite"


def _bad_object(item: SceneObject) -> Iterator[str]:
    for name, figure in item.shape.figures().items():
        yield from _not_positive(f"object {item.id!r}: {name}", figure)
    yield from _not_positive(f"object {item.id!r}: mass", item.mass)
    yield from _negative(f"object {item.id!r}: friction", item.friction or 0.0)
    for name, number in zip(("x", "y", "yaw"), (*item.position, item.yaw), strict=True):
        if not math.isfinite(number):
            yield f"object {item.id!r}: {name} is {number}, not a finite number"


def _not_positive(name: str, number: float) -> Iterator[str]:
    if not (math.isfinite(number) and number > 0.0):
        yield f"{name} is {number:g}; it must be a finite number above 0"


def _negative(name: str, number: float) -> Iterator[str]:
    if not (math.isfinite(number) and number >= 0.0):
        yield f"{name} is {number:g}; it must be a finite number of 0 or more"


def _bad_ids(ids: Sequence[str], target: str) -> Iterator[str]:
    for name, count in Counter(ids).items():
        if count > 1:
            yield f"the id {name!r} is used {count} times; ids must be unique"
    if target not in ids:
        yield f"the target {target!r} is not among the objects: {', '.join(ids) or 'there are none'}"


def _outside(shelf: Shelf, objects: Sequence[SceneObject]) -> Iterator[str]:
    for item in objects:
        for place, excess in _excess(shelf, item):
            if excess > CONTACT_TOLERANCE:
                yield f"object {item.id!r} is {excess * 1e3:.1f} mm {place}"
        if item.shape.height > shelf.height:
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
