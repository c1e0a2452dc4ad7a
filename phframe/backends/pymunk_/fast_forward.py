"""Fast-forward: while all is still, nothing happens on a straight motion until the arm meets something.

What is fast-forwarded costs no steps, and the result is the same: bodies at rest on the board stay where they are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phframe.backends.pymunk_.world import ShelfItem, ShelfSpace
from phframe.core import FloatArray, rotation_matrix

MARGIN = 1e-3
"""The arm is free as long as it is farther than this (m) from everything."""
STILL = 1e-6
"""Slower than this (m/s, rad/s) is not moving: friction brings bodies to a full stop."""
TURN_SAMPLES = 9
"""Poses looked at along a motion that turns."""


def is_still(world: ShelfSpace) -> bool:
    """Whether no object moves at all, leaving out what is held."""
    for item in world.items.values():
        x, y = item.body.velocity
        if (abs(x) > STILL or abs(y) > STILL or abs(item.body.angular_velocity) > STILL) and item.name != world.held:
            return False
    return True


def free_fraction(world: ShelfSpace, start: FloatArray, end: FloatArray) -> float:
    """The fraction, 0 to 1, of the way between two poses ``(3,)`` on which the arm and what it holds meet nothing."""
    if start[2] != end[2]:
        return 1.0 if stays_outside(world, start, end) else 0.0
    if not _clear_of_walls(world, start, end):
        return 0.0
    others = [item for item in world.items.values() if item.name != world.held]
    points, radii = _obstacles(world, others)
    back = rotation_matrix(float(start[2]))
    lower, upper = _boxes(world, back, start)
    return _first_hit((points - start[:2]) @ back, radii, lower, upper, (end[:2] - start[:2]) @ back)


def _obstacles(world: ShelfSpace, items: list[ShelfItem]) -> tuple[FloatArray, FloatArray]:
    """Centres ``(k, 2)`` and radii ``(k,)`` of the objects and, as points, of the walls' corners at the mouth."""
    points = [*(item.body.position for item in items), (0.0, 0.0), (0.0, world.scene.shelf.width)]
    return np.array(points), np.array([item.radius for item in items] + [0.0, 0.0]) + MARGIN


def _boxes(world: ShelfSpace, back: FloatArray, pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Least and greatest x and y, ``(m, 2)`` each, of the arm's parts and what it holds, in the fingertip frame (m)."""
    lower, upper = world.measures.boxes_at(world.opening)
    if world.held is None:
        return lower, upper
    item = world.items[world.held]
    center = (np.array(item.body.position) - pose[:2]) @ back
    return np.vstack([lower, center - item.radius]), np.vstack([upper, center + item.radius])


def _first_hit(points: FloatArray, radii: FloatArray, lower: FloatArray, upper: FloatArray, way: FloatArray) -> float:
    """The fraction of a way ``(2,)`` after which one of the boxes, grown by a radius, first holds a point."""
    near = lower[:, None, :] - radii[None, :, None] - points
    far = upper[:, None, :] + radii[None, :, None] - points
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = -near / way, -far / way
    inside = (near < 0.0) & (far > 0.0)
    moves = way != 0.0
    enter = np.where(moves, np.minimum(one, two), np.where(inside, -np.inf, np.inf)).max(axis=2)
    leave = np.where(moves, np.maximum(one, two), np.inf).min(axis=2)
    hits = (enter < leave) & (leave > 0.0)
    return float(min(1.0, max(0.0, enter[hits].min(initial=1.0))))


def _clear_of_walls(world: ShelfSpace, start: FloatArray, end: FloatArray) -> bool:
    """Whether every corner of the arm stays between the walls, or before the mouth, all the way."""
    corners = world.measures.corners_at(world.opening) @ rotation_matrix(float(start[2])).T
    if world.held is not None:
        item = world.items[world.held]
        rim = np.array(item.body.position) - start[:2] + item.radius * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
        corners = np.vstack([corners, rim])
    first, last = corners + start[:2], corners + end[:2]
    return bool((_before(first) & _before(last) | _between(world, first) & _between(world, last)).all())


def _before(points: FloatArray) -> NDArray[np.bool_]:
    return points[:, 0] < -MARGIN


def _between(world: ShelfSpace, points: FloatArray) -> NDArray[np.bool_]:
    shelf = world.scene.shelf
    across = (points[:, 1] > MARGIN) & (points[:, 1] < shelf.width - MARGIN)
    return np.asarray(across & (points[:, 0] < shelf.depth - MARGIN))


def stays_outside(world: ShelfSpace, start: FloatArray, end: FloatArray) -> bool:
    """Whether an empty gripper stays, between two poses, before everything that may stand out of the mouth."""
    if world.held is not None:
        return False
    reach = -max((item.radius for item in world.items.values()), default=0.0) - MARGIN
    corners = world.measures.corners_at(world.opening)
    # One that is inside to begin with, as in every step of steering, is told without looking at the rest of the way.
    return _is_outside(start[None], corners, reach) and _is_outside(_along(start, end), corners, reach)


def _along(start: FloatArray, end: FloatArray) -> FloatArray:
    """Poses ``(TURN_SAMPLES, 3)`` on the way from one to another."""
    return np.asarray(start + np.linspace(0.0, 1.0, TURN_SAMPLES)[:, None] * (end - start))


def _is_outside(poses: FloatArray, corners: FloatArray, reach: float) -> bool:
    """Whether all corners ``(v, 2)`` of the arm lie before a depth at all poses ``(k, 3)``."""
    x, y = corners.T
    fronts = poses[:, :1] + np.cos(poses[:, 2:]) * x - np.sin(poses[:, 2:]) * y
    return bool((fronts < reach).all())
