"""How far the arm, and what it holds, is from everything: while nothing moves, it can go so far in one jump."""

from __future__ import annotations

from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.distances import FAR, to_part, to_wall
from phframe.backends.fast_.layout import (
    BOTTOM,
    CORNER_X,
    CORNER_Y,
    END,
    FIRST,
    HELD,
    MIDDLE_X,
    MIDDLE_Y,
    PRESENT,
    RADIUS,
    REACH,
    TOP,
    WIDTH,
    FastWorld,
    X,
    Y,
)


@compiled
def clearance(world: FastWorld) -> float:
    """Least distance (m) from the arm, which has been laid, and from what it holds, to objects and walls."""
    held = int(world.arm[HELD])
    best = FAR
    for part in range(len(world.parts)):
        best = _part_to_walls(world, part, best)
    for row in range(len(world.bodies) - 2):
        if world.bodies[row, PRESENT] and row != held:
            best = _to_object(world, row, held, best)
    if held >= 0:
        for wall in range(3):
            distance, _, _ = to_wall(world.arm, wall, world.bodies[held, X], world.bodies[held, Y])
            best = min(best, distance - world.bodies[held, RADIUS])
    return best


@compiled
def _to_object(world: FastWorld, row: int, held: int, best: float) -> float:
    x, y, radius = world.bodies[row, X], world.bodies[row, Y], world.bodies[row, RADIUS]
    for part in range(len(world.parts)):
        around = length(x - world.parts[part, MIDDLE_X], y - world.parts[part, MIDDLE_Y]) - world.parts[part, REACH]
        if around - radius < best and world.parts[part, BOTTOM] < world.bodies[row, TOP]:
            distance, _, _ = to_part(world.parts, world.corners, part, x, y)
            best = min(best, distance - radius)
    if held >= 0:
        apart = length(x - world.bodies[held, X], y - world.bodies[held, Y])
        best = min(best, apart - radius - world.bodies[held, RADIUS])
    return best


@compiled
def _part_to_walls(world: FastWorld, part: int, best: float) -> float:
    """Of a part's corners to the walls, and of the walls' corners at the mouth to the part."""
    for wall in range(3):
        distance, _, _ = to_wall(world.arm, wall, world.parts[part, MIDDLE_X], world.parts[part, MIDDLE_Y])
        if distance - world.parts[part, REACH] < best:
            for row in range(int(world.parts[part, FIRST]), int(world.parts[part, END])):
                distance, _, _ = to_wall(world.arm, wall, world.corners[row, CORNER_X], world.corners[row, CORNER_Y])
                best = min(best, distance)
    for y in (0.0, world.arm[WIDTH]):
        distance, _, _ = to_part(world.parts, world.corners, part, 0.0, y)
        best = min(best, distance)
    return best
