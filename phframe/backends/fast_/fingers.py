"""The fingers of the gripper: opening, closing, holding, letting go."""

from __future__ import annotations

import math

from phframe.backends.fast_.compiled import compiled
from phframe.backends.fast_.layout import (
    ARM_MASS,
    ARM_VX,
    ARM_VY,
    BETWEEN,
    BODY_X,
    BODY_Y,
    BY_MASS,
    COMMAND,
    DRAG_X,
    DRAG_Y,
    GRIP_X,
    GRIP_Y,
    GRIP_YAW,
    HELD,
    MASS,
    MOST_FRICTION,
    OPENING,
    PRESENT,
    RADIUS,
    SPIN,
    TOP,
    TURN,
    VX,
    VY,
    YAW,
    FastWorld,
    X,
    Y,
)

TOUCH = 5e-4
"""A finger this near (m) to an object touches it."""


@compiled
def note_between(world: FastWorld) -> None:
    """Note which objects have their centres between the fingers."""
    for row in range(len(world.bodies) - 2):
        world.bodies[row, BETWEEN] = 1 if world.bodies[row, PRESENT] and _widest_gap(world, row) >= 0.0 else 0


@compiled
def forget_between(world: FastWorld) -> None:
    """Note that nothing is to be gripped."""
    for row in range(len(world.bodies) - 2):
        world.bodies[row, BETWEEN] = 0


@compiled
def _widest_gap(world: FastWorld, row: int) -> float:
    """The larger of the distances from the fingers' inner faces to an object's centre (m); -1 where it is not between them."""
    arm = world.arm
    cosine, sine = math.cos(arm[YAW]), math.sin(arm[YAW])
    dx, dy = world.bodies[row, X] - arm[BODY_X], world.bodies[row, Y] - arm[BODY_Y]
    x, y = cosine * dx + sine * dy, cosine * dy - sine * dx
    widest = -1.0
    for finger in range(len(world.fingers)):
        gap = arm[OPENING] / 2.0 - world.fingers[finger, 0] * y
        if not (world.fingers[finger, 1] <= x <= world.fingers[finger, 2]) or gap < 0.0:
            return -1.0
        if world.fingers[finger, 3] >= world.bodies[row, TOP]:
            return -1.0
        widest = max(widest, gap)
    return widest


@compiled
def closed_on(world: FastWorld, told: float) -> float:
    """How far the fingers close when they are told to (m): not farther than what is between them is wide."""
    for row in range(len(world.bodies) - 2):
        if world.bodies[row, BETWEEN] and _widest_gap(world, row) >= 0.0:
            told = max(told, 2.0 * world.bodies[row, RADIUS])
    return float(min(told, world.arm[OPENING]))


@compiled
def grip(world: FastWorld, command: float) -> None:
    """Hold what both fingers touch, if they do."""
    for row in range(len(world.bodies) - 2):
        if world.bodies[row, BETWEEN] and world.bodies[row, PRESENT] and world.arm[HELD] < 0.0:
            gap = _widest_gap(world, row)
            if 0.0 <= gap <= world.bodies[row, RADIUS] + TOUCH:
                hold(world, row, command)


@compiled
def hold(world: FastWorld, row: int, command: float) -> None:
    """Join an object to the gripper; the fingers go on being told an opening (m), and squeeze for it."""
    arm = world.arm
    cosine, sine = math.cos(arm[YAW]), math.sin(arm[YAW])
    dx, dy = world.bodies[row, X] - arm[BODY_X], world.bodies[row, Y] - arm[BODY_Y]
    arm[HELD], arm[COMMAND] = row, command
    arm[GRIP_X], arm[GRIP_Y] = cosine * dx + sine * dy, cosine * dy - sine * dx
    arm[GRIP_YAW] = world.bodies[row, TURN] - arm[YAW]
    world.bodies[row, VX] = world.bodies[row, VY] = world.bodies[row, SPIN] = 0.0
    world.bodies[len(world.bodies) - 2, BY_MASS] = 1.0 / (world.arm[ARM_MASS] + world.bodies[row, MASS])
    forget_between(world)


@compiled
def release(world: FastWorld) -> None:
    """Let go: what was held stands on the board, and has the arm's speed."""
    arm, row = world.arm, int(world.arm[HELD])
    world.bodies[row, VX], world.bodies[row, VY] = arm[ARM_VX], arm[ARM_VY]
    arm[HELD] = -1.0
    arm[DRAG_X] = arm[DRAG_Y] = 0.0
    world.bodies[len(world.bodies) - 2, BY_MASS] = 1.0 / world.arm[ARM_MASS]


@compiled
def drag_force(world: FastWorld) -> float:
    """What it takes to move what is held along the board (N)."""
    held = int(world.arm[HELD])
    return float(world.bodies[held, MOST_FRICTION]) if held >= 0 and world.bodies[held, X] >= 0.0 else 0.0


@compiled
def told_opening(world: FastWorld, told: float) -> float:
    """The opening (m) that fingers which are told one come to; they leave what they hold once they are told to be wider."""
    arm = world.arm
    if arm[HELD] >= 0.0 and told <= arm[OPENING]:
        arm[COMMAND] = told
        return float(arm[OPENING])
    if arm[HELD] >= 0.0:
        release(world)
    return told if told >= arm[OPENING] else closed_on(world, told)
