"""What makes a scene impossible, in sentences for people."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from phframe.core.scene import Scene, SceneObject

CONTACT_TOLERANCE = 1e-6
"""Objects may touch; less than this much (m) into each other counts as touching."""


def problems_of(scene: Scene) -> list[str]:
    """Everything wrong with a scene, one sentence each; geometry is only looked at when the figures are sound."""
    problems = [*_bad_figures(scene), *_bad_ids(scene)]
    return problems or [*_outside(scene), *_overlapping(scene)]


def _bad_figures(scene: Scene) -> Iterator[str]:
    shelf = scene.shelf
    for name in ("depth", "width", "height"):
        yield from _not_positive(f"shelf {name}", getattr(shelf, name))
    for name in ("board_friction", "wall_friction"):
        yield from _negative(f"shelf {name}", getattr(shelf, name))
    for item in scene.objects:
        yield from _bad_object(item)
    for name, base_pose in scene.base_poses.items():
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


def _bad_ids(scene: Scene) -> Iterator[str]:
    for name, count in Counter(scene.ids).items():
        if count > 1:
            yield f"the id {name!r} is used {count} times; ids must be unique"
    if scene.target not in scene.ids:
        yield f"the target {scene.target!r} is not among the objects: {', '.join(scene.ids) or 'there are none'}"


def _outside(scene: Scene) -> Iterator[str]:
    for item in scene.objects:
        for place, excess in _excess(scene, item):
            if excess > CONTACT_TOLERANCE:
                yield f"object {item.id!r} is {excess * 1e3:.1f} mm {place}"
        if item.shape.height > scene.shelf.height:
            yield f"object {item.id!r} is {item.shape.height:g} m tall; the shelf is {scene.shelf.height:g} m high"


def _excess(scene: Scene, item: SceneObject) -> Iterator[tuple[str, float]]:
    (x, y), r, shelf = item.position, item.radius, scene.shelf
    yield "inside the south wall", r - y
    yield "inside the north wall", y + r - shelf.width
    yield "inside the back wall", x + r - shelf.depth
    yield "outside the mouth with its centre", -x


def _overlapping(scene: Scene) -> Iterator[str]:
    for a, b in combinations(scene.objects, 2):
        depth = a.radius + b.radius - math.dist(a.position, b.position)
        if depth > CONTACT_TOLERANCE:
            yield f"objects {a.id!r} and {b.id!r} overlap by {depth * 1e3:.1f} mm"
