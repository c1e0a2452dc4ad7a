"""One step of a world: contacts, impulses, positions."""

from __future__ import annotations

import math

from phframe.backends.fast_.clearance import clearance
from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.contacts import find_contacts
from phframe.backends.fast_.distances import lay_arm
from phframe.backends.fast_.fingers import drag_force
from phframe.backends.fast_.layout import (
    ARM_VX,
    ARM_VY,
    AWAKE,
    BODY_A,
    BODY_B,
    BODY_X,
    BODY_Y,
    BY_MASS,
    CARRIER_X,
    CARRIER_Y,
    CARRIER_YAW,
    DRAG_X,
    DRAG_Y,
    DRIVE_X,
    DRIVE_Y,
    FRICTION_LEVER,
    GAP,
    GIVEN_N,
    GRIP_X,
    GRIP_Y,
    GRIP_YAW,
    HELD,
    IMPULSE_N,
    MASS,
    MOST_FRICTION,
    NORMAL_X,
    NORMAL_Y,
    OPENING,
    RADIUS,
    RESTING,
    SATURATED,
    SPIN,
    SPIN_BEFORE,
    TURN,
    VX,
    VX_BEFORE,
    VY,
    VY_BEFORE,
    YAW,
    FastWorld,
    X,
    Y,
)
from phframe.backends.fast_.solver import solve
from phframe.core import FloatArray

STILL = 1e-7
"""Slower than this (m/s, rim included) is not moving."""
SLACK = 5e-4
"""Things farther apart than they can come in a step, and this (m), do not touch in it."""
WORKED_OFF, OVERLAP = 0.3, 1e-5
"""Fraction of an overlap worked off in a step, and how much of it is left (m)."""
CATCH_UP = 0.3
"""Fraction of what it lags behind that the arm makes good in a step."""
FULL = 0.999
"""Fraction of the force limit at which the drive has nothing left to give."""
NEAR = 1e-4
"""The arm goes in jumps as long as it is farther than this (m) from everything."""
LEVER = 0.25
"""What turning moves the arm by where it matters to the length of a step (m/rad)."""


@compiled
def step(world: FastWorld, h: float, x: float, y: float, yaw: float, opening: float, force: float) -> int:
    """Go on by a step.

    Args:
        world: The world.
        h: Length of the step (s).
        x: Where the carrier is at its end (m).
        y: Likewise.
        yaw: Likewise (rad).
        opening: Of the fingers at its end (m).
        force: Limit of the drive (N).

    Returns:
        The number of contacts, which stay in ``world.rows``.
    """
    arm, tip = world.arm, len(world.bodies) - 2
    turn, widening = (yaw - arm[YAW]) / h, (opening - arm[OPENING]) / h
    vx = (x - arm[CARRIER_X] + CATCH_UP * (arm[CARRIER_X] - arm[BODY_X])) / h
    vy = (y - arm[CARRIER_Y] + CATCH_UP * (arm[CARRIER_Y] - arm[BODY_Y])) / h
    if arm[SATURATED] == 0.0 and drag_force(world) < force:
        arm[ARM_VX], arm[ARM_VY] = vx, vy  # the drive need not accelerate the arm itself, nor what it can carry
    world.bodies[tip, VX], world.bodies[tip, VY], world.bodies[tip, SPIN] = arm[ARM_VX], arm[ARM_VY], 0.0
    fastest = length(vx, vy) + abs(turn) * LEVER + abs(widening) / 2.0 + _fastest(world.bodies)
    lay_arm(world)
    found = find_contacts(world, h, fastest * h + SLACK, turn, widening)
    _keep_speeds(world)
    solve(world, found, h, force, vx, vy, turn)
    _move_objects(world, found, h)
    _move_arm(world, tip, h)
    arm[CARRIER_X], arm[CARRIER_Y], arm[CARRIER_YAW], arm[YAW] = x, y, yaw, yaw
    arm[OPENING] = opening
    _separate(world, found, h)
    carry(world)
    arm[SATURATED] = 1.0 if length(arm[DRIVE_X], arm[DRIVE_Y]) >= FULL * force else 0.0
    return found


@compiled
def _fastest(bodies: FloatArray) -> float:
    """Speed of the fastest object (m/s)."""
    best = 0.0
    for row in range(len(bodies) - 2):
        best = max(best, length(bodies[row, VX], bodies[row, VY]))
    return best


@compiled
def _keep_speeds(world: FastWorld) -> None:
    """Keep the speeds at the beginning of the step: half the way of what slides freely is theirs."""
    for row in range(len(world.bodies) - 2):
        world.bodies[row, VX_BEFORE] = world.bodies[row, VX]
        world.bodies[row, VY_BEFORE] = world.bodies[row, VY]
        world.bodies[row, SPIN_BEFORE] = world.bodies[row, SPIN]


@compiled
def _move_objects(world: FastWorld, found: int, h: float) -> None:
    """By the speeds at the end of the step; what touched nothing, as sliding friction has it: evenly slower, then at rest."""
    bodies, rows, count = world.bodies, world.rows, len(world.bodies) - 2
    for row in range(count):
        bodies[row, AWAKE] = min(bodies[row, AWAKE], 1.0)
    for contact in range(found):
        if rows[contact, IMPULSE_N] > 0.0:
            bodies[int(rows[contact, BODY_A]), AWAKE] = 2.0
            bodies[int(rows[contact, BODY_B]), AWAKE] = 2.0
    for row in range(count):
        if bodies[row, AWAKE] != 0.0:
            _move(bodies, row, h)


@compiled
def _move(bodies: FloatArray, row: int, h: float) -> None:
    lever = bodies[row, FRICTION_LEVER]
    if length(bodies[row, VX], bodies[row, VY]) + abs(bodies[row, SPIN]) * bodies[row, RADIUS] < STILL:
        bodies[row, VX] = bodies[row, VY] = bodies[row, SPIN] = 0.0
    first, last, slide = 0.0, 1.0, h
    if bodies[row, AWAKE] == 1.0:
        first = last = 0.5
        if bodies[row, VX] == 0.0 and bodies[row, VY] == 0.0 and bodies[row, SPIN] == 0.0:
            sliding = length(bodies[row, VX_BEFORE], bodies[row, VY_BEFORE])
            speed = length(sliding, bodies[row, SPIN_BEFORE] * lever)
            slide = min(h, speed * bodies[row, MASS] / max(bodies[row, MOST_FRICTION], 1e-9))
    bodies[row, X] += (first * bodies[row, VX_BEFORE] + last * bodies[row, VX]) * slide
    bodies[row, Y] += (first * bodies[row, VY_BEFORE] + last * bodies[row, VY]) * slide
    bodies[row, TURN] += (first * bodies[row, SPIN_BEFORE] + last * bodies[row, SPIN]) * slide


@compiled
def _move_arm(world: FastWorld, tip: int, h: float) -> None:
    arm = world.arm
    arm[ARM_VX], arm[ARM_VY] = world.bodies[tip, VX], world.bodies[tip, VY]
    arm[BODY_X] += arm[ARM_VX] * h
    arm[BODY_Y] += arm[ARM_VY] * h


@compiled
def carry(world: FastWorld) -> None:
    """What is held goes where the gripper goes."""
    arm, held = world.arm, int(world.arm[HELD])
    if held >= 0:
        cosine, sine = math.cos(arm[YAW]), math.sin(arm[YAW])
        world.bodies[held, X] = arm[BODY_X] + cosine * arm[GRIP_X] - sine * arm[GRIP_Y]
        world.bodies[held, Y] = arm[BODY_Y] + sine * arm[GRIP_X] + cosine * arm[GRIP_Y]
        world.bodies[held, TURN] = arm[YAW] + arm[GRIP_YAW]


@compiled
def _separate(world: FastWorld, found: int, h: float) -> None:
    """Work overlaps off, in positions alone, so that they give nothing any speed; the arm gives way where it is stalled."""
    tip = len(world.bodies) - 2
    gives = world.bodies[tip, BY_MASS] if world.arm[SATURATED] == 1.0 else 0.0
    rows = world.rows
    for contact in range(found):
        a, b = int(rows[contact, BODY_A]), int(rows[contact, BODY_B])
        away = (world.bodies[b, VX] - world.bodies[a, VX]) * rows[contact, NORMAL_X]
        away += (world.bodies[b, VY] - world.bodies[a, VY]) * rows[contact, NORMAL_Y] + rows[contact, GIVEN_N]
        overlap = -rows[contact, GAP] - away * h - OVERLAP
        if overlap <= 0.0:
            continue
        of_a = gives if a == tip else world.bodies[a, BY_MASS]
        of_b = gives if b == tip else world.bodies[b, BY_MASS]
        if of_a + of_b > 0.0:
            share = WORKED_OFF * overlap / (of_a + of_b)
            _shift(
                world.bodies,
                world.arm,
                a,
                -share * of_a * rows[contact, NORMAL_X],
                -share * of_a * rows[contact, NORMAL_Y],
            )
            _shift(
                world.bodies,
                world.arm,
                b,
                share * of_b * rows[contact, NORMAL_X],
                share * of_b * rows[contact, NORMAL_Y],
            )


@compiled
def _shift(bodies: FloatArray, arm: FloatArray, body: int, dx: float, dy: float) -> None:
    tip = len(bodies) - 2
    if body < tip:
        bodies[body, X] += dx
        bodies[body, Y] += dy
    elif body == tip:
        arm[BODY_X] += dx
        arm[BODY_Y] += dy


@compiled
def rest(world: FastWorld) -> bool:
    """Whether no object moves at all; noted in the world."""
    resting = _fastest(world.bodies) == 0.0
    for row in range(len(world.bodies) - 2):
        resting = resting and world.bodies[row, SPIN] == 0.0
    world.arm[RESTING] = 1.0 if resting else 0.0
    return resting


@compiled
def free_time(world: FastWorld, speed: float) -> float:
    """How long (s) the arm can go on until it could meet anything, if no point of it is faster than ``speed`` (m/s)."""
    lay_arm(world)
    return (clearance(world) - NEAR) / speed if speed > 0.0 else math.inf


@compiled
def place(world: FastWorld, x: float, y: float, yaw: float, opening: float) -> None:
    """Put the arm where it is free, with what it holds."""
    arm = world.arm
    arm[BODY_X] = arm[CARRIER_X] = x
    arm[BODY_Y] = arm[CARRIER_Y] = y
    arm[YAW] = arm[CARRIER_YAW] = yaw
    arm[OPENING] = opening
    arm[ARM_VX] = arm[ARM_VY] = arm[SATURATED] = 0.0
    arm[DRIVE_X] = arm[DRIVE_Y] = arm[DRAG_X] = arm[DRAG_Y] = 0.0
    carry(world)
