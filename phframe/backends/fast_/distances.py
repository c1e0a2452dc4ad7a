"""Signed distances of discs, boxes and convex polygons."""

from __future__ import annotations

import math

from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.layout import (
    BODY_X,
    BODY_Y,
    CORNER_X,
    CORNER_Y,
    DEPTH,
    EDGE_NX,
    EDGE_NY,
    END,
    FIRST,
    MIDDLE_X,
    MIDDLE_Y,
    MIN_OPENING,
    NORTH,
    OPENING,
    OWN_NX,
    OWN_NY,
    OWN_X,
    OWN_Y,
    SIDE,
    SOUTH,
    WALL_THICKNESS,
    WIDTH,
    YAW,
    FastWorld,
)
from phframe.core import FloatArray

Measured = tuple[float, float, float]
"""A signed distance (m) and the direction in which it grows: x, y."""
FAR = 1e9


@compiled
def lay_arm(world: FastWorld) -> None:
    """Where the arm's corners, normals and circles lie in the shelf."""
    arm, parts, corners = world.arm, world.parts, world.corners
    cosine, sine = math.cos(arm[YAW]), math.sin(arm[YAW])
    shift = (arm[OPENING] - world.arm[MIN_OPENING]) / 2.0
    for part in range(len(parts)):
        aside = parts[part, SIDE] * shift
        x, y = parts[part, OWN_X], parts[part, OWN_Y] + aside
        parts[part, MIDDLE_X] = arm[BODY_X] + cosine * x - sine * y
        parts[part, MIDDLE_Y] = arm[BODY_Y] + sine * x + cosine * y
        for row in range(int(parts[part, FIRST]), int(parts[part, END])):
            x, y = corners[row, OWN_X], corners[row, OWN_Y] + aside
            corners[row, CORNER_X] = arm[BODY_X] + cosine * x - sine * y
            corners[row, CORNER_Y] = arm[BODY_Y] + sine * x + cosine * y
            x, y = corners[row, OWN_NX], corners[row, OWN_NY]
            corners[row, EDGE_NX] = cosine * x - sine * y
            corners[row, EDGE_NY] = sine * x + cosine * y


@compiled
def to_part(parts: FloatArray, corners: FloatArray, part: int, x: float, y: float) -> Measured:
    """From a part of the arm to a point; from its edge or corner that is nearest."""
    begin, end = int(parts[part, FIRST]), int(parts[part, END])
    best, edge = -FAR, begin
    for row in range(begin, end):
        distance = (x - corners[row, CORNER_X]) * corners[row, EDGE_NX] + (y - corners[row, CORNER_Y]) * corners[
            row, EDGE_NY
        ]
        if distance > best:
            best, edge = distance, row
    nx, ny = corners[edge, EDGE_NX], corners[edge, EDGE_NY]
    if best <= 0.0:
        return best, nx, ny
    following = begin if edge + 1 == end else edge + 1
    for corner, sign in ((edge, 1.0), (following, -1.0)):
        dx, dy = x - corners[corner, CORNER_X], y - corners[corner, CORNER_Y]
        if sign * (-ny * dx + nx * dy) < 0.0:
            distance = length(dx, dy)
            return distance, dx / distance, dy / distance
    return best, nx, ny


@compiled
def to_wall(arm: FloatArray, wall: int, x: float, y: float) -> Measured:
    """From a wall, a box that ends at the mouth, to a point."""
    depth, width = arm[DEPTH], arm[WIDTH]
    if wall == SOUTH:
        return _to_box(0.0, -WALL_THICKNESS, depth, 0.0, x, y)
    if wall == NORTH:
        return _to_box(0.0, width, depth, width + WALL_THICKNESS, x, y)
    return _to_box(depth, -WALL_THICKNESS, depth + WALL_THICKNESS, width + WALL_THICKNESS, x, y)


@compiled
def _to_box(left: float, low: float, right: float, high: float, x: float, y: float) -> Measured:
    nearest_x, nearest_y = min(max(x, left), right), min(max(y, low), high)
    dx, dy = x - nearest_x, y - nearest_y
    distance = length(dx, dy)
    if distance > 0.0:
        return distance, dx / distance, dy / distance
    best, nx, ny = x - left, -1.0, 0.0
    if right - x < best:
        best, nx = right - x, 1.0
    if y - low < best:
        best, nx, ny = y - low, 0.0, -1.0
    if high - y < best:
        best, nx, ny = high - y, 0.0, 1.0
    return -best, nx, ny
