"""The contacts of a step: what touches, or could within the step (speculative contacts), of all that may move."""

from __future__ import annotations

import math

from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.distances import to_part, to_wall
from phframe.backends.fast_.layout import (
    ARM_FRICTION,
    AWAKE,
    BODY_A,
    BODY_B,
    BODY_X,
    BODY_Y,
    BOTTOM,
    BY_INERTIA,
    BY_MASS,
    CORNER_X,
    CORNER_Y,
    END,
    FIRST,
    FRICTION,
    GAP,
    GIVEN_N,
    GIVEN_T,
    HELD,
    IMPULSE_N,
    IMPULSE_T,
    LEAST,
    LEVER_A,
    LEVER_B,
    MASS_N,
    MASS_T,
    MIDDLE_X,
    MIDDLE_Y,
    NORMAL_X,
    NORMAL_Y,
    OBJECT_FRICTION,
    ORDER,
    PRESENT,
    RADIUS,
    REACH,
    SIDE,
    SPIN,
    STEPS,
    TOP,
    TOUCHER_A,
    TOUCHER_B,
    VX,
    VY,
    WALL_FRICTION,
    WIDTH,
    YAW,
    FastWorld,
    X,
    Y,
)
from phframe.core import FloatArray

Pair = tuple[int, int, int, int]
"""Body a, body b, and their numbers as what touches."""


@compiled
def find_contacts(world: FastWorld, h: float, reach: float, turn: float, opening: float) -> int:
    """Write down the contacts of a step, and wake what they are with.

    Args:
        world: The world.
        h: Length of the step (s).
        reach: How far apart things may be that touch within it (m).
        turn: Of the arm (rad/s).
        opening: Of the fingers (m/s).

    Returns:
        How many.
    """
    count = len(world.bodies) - 2
    for row in range(count):
        moving = world.bodies[row, VX] != 0.0 or world.bodies[row, VY] != 0.0 or world.bodies[row, SPIN] != 0.0
        world.bodies[row, AWAKE] = 1 if moving and world.bodies[row, PRESENT] and row != int(world.arm[HELD]) else 0
    found = _contacts_of_arm(world, h, reach, turn, opening, 0)
    waiting = 0
    for row in range(count):
        if world.bodies[row, AWAKE]:
            world.bodies[waiting, ORDER] = row
            waiting += 1
    done = 0
    while done < waiting:
        found, waiting = _contacts_of_object(world, h, reach, done, waiting, found)
        done += 1
    return found


@compiled
def _contacts_of_object(
    world: FastWorld, h: float, reach: float, done: int, waiting: int, found: int
) -> tuple[int, int]:
    """With other objects and with walls; each pair once: 2 in ``awake`` marks those whose contacts are known."""
    row, count = int(world.bodies[done, ORDER]), len(world.bodies) - 2
    world.bodies[row, AWAKE] = 2
    x, y, radius = world.bodies[row, X], world.bodies[row, Y], world.bodies[row, RADIUS]
    for other in range(count):
        if world.bodies[other, AWAKE] == 2 or not world.bodies[other, PRESENT] or other == int(world.arm[HELD]):
            continue
        dx, dy, together = world.bodies[other, X] - x, world.bodies[other, Y] - y, radius + world.bodies[other, RADIUS]
        if dx * dx + dy * dy >= (together + reach) ** 2:
            continue
        apart = length(dx, dy)
        nx, ny = (dx / apart, dy / apart) if apart > 0.0 else (1.0, 0.0)
        pair = (row, other, row, other)
        found = _add(
            world, h, found, pair, (apart - together, nx, ny), (radius, world.bodies[other, RADIUS]), (0.0, 0.0)
        )
        if world.bodies[other, AWAKE] == 0:
            world.bodies[other, AWAKE] = 1
            world.bodies[waiting, ORDER] = other
            waiting += 1
    for wall in range(3):
        gap, nx, ny = to_wall(world.arm, wall, x, y)
        if gap - radius < reach:
            pair = (count + 1, row, count + len(world.parts) + 1 + wall, row)
            found = _add(world, h, found, pair, (gap - radius, nx, ny), (0.0, radius), (0.0, 0.0))
    return found, waiting


@compiled
def _contacts_of_arm(world: FastWorld, h: float, reach: float, turn: float, opening: float, found: int) -> int:
    held, count = int(world.arm[HELD]), len(world.bodies) - 2
    parts = len(world.parts)
    for row in range(count):
        if not world.bodies[row, PRESENT] or row == held:
            continue
        x, y, radius = world.bodies[row, X], world.bodies[row, Y], world.bodies[row, RADIUS]
        for part in range(parts):
            if _is_apart(world, part, row, reach):
                continue
            distance, nx, ny = to_part(world.parts, world.corners, part, x, y)
            if distance - radius >= reach:
                continue
            given = _given(
                world.arm, turn, world.parts[part, SIDE] * opening / 2.0, x - nx * distance, y - ny * distance
            )
            pair = (count, row, count + part, row)
            found = _add(world, h, found, pair, (distance - radius, nx, ny), (0.0, radius), (-given[0], -given[1]))
            world.bodies[row, AWAKE] = max(world.bodies[row, AWAKE], 1)
        if held >= 0:
            found = _held_to_object(world, h, reach, turn, row, found)
    for part in range(parts):
        found = _part_to_walls(world, h, reach, turn, opening, part, found)
    return _held_to_walls(world, h, reach, turn, found) if held >= 0 else found


@compiled
def _is_apart(world: FastWorld, part: int, row: int, reach: float) -> bool:
    """Whether a part of the arm passes over an object, or is beyond reach of it (m) by the circles around them."""
    dx, dy = world.bodies[row, X] - world.parts[part, MIDDLE_X], world.bodies[row, Y] - world.parts[part, MIDDLE_Y]
    apart = length(dx, dy) - world.parts[part, REACH] - world.bodies[row, RADIUS]
    return bool(apart >= reach or world.parts[part, BOTTOM] >= world.bodies[row, TOP])


@compiled
def _given(arm: FloatArray, turn: float, aside: float, x: float, y: float) -> tuple[float, float]:
    """The velocity (m/s) that turning and opening give to a point of the arm."""
    cosine, sine = math.cos(arm[YAW]), math.sin(arm[YAW])
    return -turn * (y - arm[BODY_Y]) - sine * aside, turn * (x - arm[BODY_X]) + cosine * aside


@compiled
def _held_to_object(world: FastWorld, h: float, reach: float, turn: float, row: int, found: int) -> int:
    held, count = int(world.arm[HELD]), len(world.bodies) - 2
    hx, hy = world.bodies[held, X], world.bodies[held, Y]
    dx, dy = world.bodies[row, X] - hx, world.bodies[row, Y] - hy
    apart, own = length(dx, dy), world.bodies[held, RADIUS]
    gap = apart - own - world.bodies[row, RADIUS]
    if gap >= reach:
        return found
    nx, ny = (dx / apart, dy / apart) if apart > 0.0 else (1.0, 0.0)
    given = _given(world.arm, turn, 0.0, hx + nx * own, hy + ny * own)
    world.bodies[row, AWAKE] = max(world.bodies[row, AWAKE], 1)
    pair = (count, row, count + len(world.parts), row)
    return _add(world, h, found, pair, (gap, nx, ny), (0.0, world.bodies[row, RADIUS]), (-given[0], -given[1]))


@compiled
def _held_to_walls(world: FastWorld, h: float, reach: float, turn: float, found: int) -> int:
    held, count, parts = int(world.arm[HELD]), len(world.bodies) - 2, len(world.parts)
    x, y, radius = world.bodies[held, X], world.bodies[held, Y], world.bodies[held, RADIUS]
    for wall in range(3):
        distance, nx, ny = to_wall(world.arm, wall, x, y)
        if distance - radius < reach:
            given = _given(world.arm, turn, 0.0, x - nx * radius, y - ny * radius)
            pair = (count + 1, count, count + parts + 1 + wall, count + parts)
            found = _add(world, h, found, pair, (distance - radius, nx, ny), (0.0, 0.0), given)
    return found


@compiled
def _part_to_walls(world: FastWorld, h: float, reach: float, turn: float, opening: float, part: int, found: int) -> int:
    """A part's corners on walls, and the walls' corners at the mouth on a part. Walls give way to nothing: not remembered."""
    count, aside = len(world.bodies) - 2, world.parts[part, SIDE] * opening / 2.0
    for wall in range(3):
        middle, _, _ = to_wall(world.arm, wall, world.parts[part, MIDDLE_X], world.parts[part, MIDDLE_Y])
        if middle - world.parts[part, REACH] >= reach:
            continue
        for corner in range(int(world.parts[part, FIRST]), int(world.parts[part, END])):
            x, y = world.corners[corner, CORNER_X], world.corners[corner, CORNER_Y]
            measured = to_wall(world.arm, wall, x, y)
            if measured[0] < reach:
                given = _given(world.arm, turn, aside, x, y)
                pair = (count + 1, count, -1 - wall, -1 - part)
                found = _add(world, h, found, pair, measured, (0.0, 0.0), given)
    for wall in range(2):
        y = wall * world.arm[WIDTH]
        distance, nx, ny = to_part(world.parts, world.corners, part, 0.0, y)
        if distance < reach:
            given = _given(world.arm, turn, aside, -nx * distance, y - ny * distance)
            pair = (count + 1, count, -1 - wall, -1 - part)
            found = _add(world, h, found, pair, (distance, -nx, -ny), (0.0, 0.0), given)
    return found


@compiled
def _add(
    world: FastWorld,
    h: float,
    found: int,
    pair: Pair,
    measured: tuple[float, float, float],
    levers: tuple[float, float],
    given: tuple[float, float],
) -> int:
    """Write a contact down, with the impulses that it had in the last step."""
    if found == len(world.rows):
        return found
    a, b, toucher_a, toucher_b = pair
    gap, nx, ny = measured
    rows, count = world.rows, len(world.bodies) - 2
    rows[found, BODY_A], rows[found, BODY_B], rows[found, NORMAL_X], rows[found, NORMAL_Y], rows[found, GAP] = (
        a,
        b,
        nx,
        ny,
        gap,
    )
    rows[found, LEVER_A], rows[found, LEVER_B] = levers
    rows[found, GIVEN_N], rows[found, GIVEN_T] = nx * given[0] + ny * given[1], nx * given[1] - ny * given[0]
    rows[found, FRICTION] = _friction(world.arm, count, a)
    rows[found, LEAST] = -gap / h if gap > 0.0 else 0.0
    mass = world.bodies[a, BY_MASS] + world.bodies[b, BY_MASS]
    spin = levers[0] ** 2 * world.bodies[a, BY_INERTIA] + levers[1] ** 2 * world.bodies[b, BY_INERTIA]
    rows[found, MASS_N], rows[found, MASS_T] = 1.0 / mass, 1.0 / (mass + spin)
    rows[found, TOUCHER_A], rows[found, TOUCHER_B] = toucher_a, toucher_b
    rows[found, IMPULSE_N] = rows[found, IMPULSE_T] = 0.0
    if toucher_a >= 0:
        low, high = min(toucher_a, toucher_b), max(toucher_a, toucher_b)
        if world.remembered[low, high, 2] == world.arm[STEPS]:
            rows[found, IMPULSE_N] = world.remembered[low, high, 0] * h
            rows[found, IMPULSE_T] = world.remembered[low, high, 1] * h
    return found + 1


@compiled
def _friction(arm: FloatArray, count: int, a: int) -> float:
    if a == count + 1:
        return float(arm[WALL_FRICTION])
    return float(arm[ARM_FRICTION] if a == count else arm[OBJECT_FRICTION])
