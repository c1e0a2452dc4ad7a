"""Fast-forward: while all is still, nothing happens on a straight motion until the arm meets something.

What is fast-forwarded costs no steps, and the result is the same: bodies at rest on the board stay where they are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from phframe.backends.pymunk_.chipmunk import Point
from phframe.backends.pymunk_.measures import Box, around
from phframe.backends.pymunk_.world import ShelfSpace

MARGIN = 1e-3
"""The arm is free as long as it is farther than this (m) from everything."""
STILL = 1e-6
"""Slower than this (m/s, rad/s) is not moving: friction brings bodies to a full stop."""
TURN_SAMPLES = 9
"""Poses looked at along a motion that turns."""

Pose = Sequence[float]
"""x, y (m) and yaw (rad) of the fingertip."""


def is_still(world: ShelfSpace) -> bool:
    """Whether no object moves at all, leaving out what is held."""
    for item in world.movable:
        x, y = item.body.velocity
        if (abs(x) > STILL or abs(y) > STILL or abs(item.body.angular_velocity) > STILL) and item.name != world.held:
            return False
    return True


def free_fraction(world: ShelfSpace, start: Pose, end: Pose) -> float:
    """The fraction, 0 to 1, of the way between two poses on which the arm and what it holds meet nothing."""
    if start[2] != end[2]:
        return 1.0 if stays_outside(world, start, end) else 0.0
    if not _clear_of_walls(world, start, end):
        return 0.0
    turn = math.cos(start[2]), math.sin(start[2])
    boxes = world.measures.boxes_at(world.opening)
    if world.held is not None:
        item = world.items[world.held]
        x, y = _seen(item.body.position, start, turn)
        boxes.append((x - item.radius, y - item.radius, x + item.radius, y + item.radius))
    way = _seen((end[0], end[1]), start, turn)
    hull = around(boxes)
    first = 1.0
    for point, radius in _obstacles(world):
        at = _seen(point, start, turn)
        if _meets(at, radius, hull, way) < first:
            first = min(first, *(_meets(at, radius, box, way) for box in boxes))
    return max(0.0, first)


def _obstacles(world: ShelfSpace) -> list[tuple[Point, float]]:
    """Centres and radii, the margin included, of the objects and, as points, of the walls' corners at the mouth (m).

    What all of the arm passes over is in the way of nothing but what is held.
    """
    met = [item for item in world.items.values() if item.meets_arm] if world.held is None else world.items.values()
    objects = [(item.body.position, item.radius + MARGIN) for item in met if item.name != world.held]
    return [*objects, ((0.0, 0.0), MARGIN), ((0.0, world.scene.shelf.width), MARGIN)]


def _seen(point: Point, pose: Pose, turn: Point) -> Point:
    """A point of the shelf in the frame of a pose with a cosine and sine."""
    x, y = point[0] - pose[0], point[1] - pose[1]
    return x * turn[0] + y * turn[1], y * turn[0] - x * turn[1]


def _meets(point: Point, radius: float, box: Box, way: Point) -> float:
    """The fraction of a way after which a box, grown by a radius, first holds a point; infinite where it never does."""
    enter, leave = -math.inf, math.inf
    for axis in (0, 1):
        near, far = box[axis] - radius - point[axis], box[axis + 2] + radius - point[axis]
        if way[axis] != 0.0:
            one, two = -near / way[axis], -far / way[axis]
            enter, leave = max(enter, min(one, two)), min(leave, max(one, two))
        elif not near < 0.0 < far:
            return math.inf
    # One that it holds and moves on from at once, or that lies behind, is not met: the way ends where it begins.
    return enter if enter < leave and leave > 0.0 else math.inf


def _clear_of_walls(world: ShelfSpace, start: Pose, end: Pose) -> bool:
    """Whether every corner of the arm stays between the walls, or before the mouth, all the way."""
    c, s = math.cos(start[2]), math.sin(start[2])
    corners = [(x * c - y * s, x * s + y * c) for x, y in world.measures.corners_at(world.opening)]
    if world.held is not None:
        item = world.items[world.held]
        (x, y), r = item.body.position, item.radius
        corners += [(x - start[0] + r * i, y - start[1] + r * j) for i in (1, -1) for j in (1, -1)]
    shelf = world.scene.shelf
    deepest, widest = shelf.depth - MARGIN, shelf.width - MARGIN
    for x, y in corners:
        x0, y0, x1, y1 = x + start[0], y + start[1], x + end[0], y + end[1]
        before = x0 < -MARGIN and x1 < -MARGIN
        if not before and not (MARGIN < y0 < widest and MARGIN < y1 < widest and x0 < deepest and x1 < deepest):
            return False
    return True


def stays_outside(world: ShelfSpace, start: Pose, end: Pose) -> bool:
    """Whether an empty gripper stays, between two poses, before everything that may stand out of the mouth."""
    if world.held is not None:
        return False
    reach = -max((item.radius for item in world.items.values()), default=0.0) - MARGIN
    corners = world.measures.corners_at(world.opening)
    fractions = (sample / (TURN_SAMPLES - 1) for sample in range(TURN_SAMPLES))
    return all(_is_outside(_along(start, end, fraction), corners, reach) for fraction in fractions)


def _along(start: Pose, end: Pose, fraction: float) -> Pose:
    return [a + fraction * (b - a) for a, b in zip(start, end, strict=True)]


def _is_outside(pose: Pose, corners: list[Point], reach: float) -> bool:
    """Whether all corners of the arm at a pose lie before a depth."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return all(pose[0] + c * x - s * y < reach for x, y in corners)
