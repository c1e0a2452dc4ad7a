"""Impulses of one step: projected Gauss-Seidel at the level of velocities.

Contacts keep to Signorini's condition and Coulomb's cone, the board to a limit surface (Goyal, Ruina and Papadopoulos, Planar
sliding with dry friction, Wear 143, 1991): an ellipsoid in force and torque, |(fx, fy, torque / c)| <= mu m g. The arm has a
force limit of its own, so that every commanded motion has a solution (Halm and Posa, A quasi-static model and simulation
approach for pushing, grasping, and jamming, WAFR 2018): a drive of limited force that draws it along.
"""

from __future__ import annotations

import math

from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.fingers import drag_force
from phframe.backends.fast_.layout import (
    AWAKE,
    BODY_A,
    BODY_B,
    BODY_X,
    BODY_Y,
    BY_INERTIA,
    BY_MASS,
    DRAG_X,
    DRAG_Y,
    DRIVE_X,
    DRIVE_Y,
    FLOOR_TORQUE,
    FLOOR_X,
    FLOOR_Y,
    FRICTION,
    FRICTION_LEVER,
    GIVEN_N,
    GIVEN_T,
    HELD,
    IMPULSE_N,
    IMPULSE_T,
    INERTIA,
    ITERATIONS,
    LEAST,
    LEVER_A,
    LEVER_B,
    MASS,
    MASS_N,
    MASS_T,
    MOST_FRICTION,
    NORMAL_X,
    NORMAL_Y,
    SPIN,
    STEPS,
    TOUCHER_A,
    TOUCHER_B,
    VX,
    VY,
    FastWorld,
    X,
    Y,
)
from phframe.core import FloatArray

CONVERGED = 1e-5
"""No velocity (m/s) changes by more in the last iteration."""


@compiled
def solve(world: FastWorld, found: int, h: float, force: float, vx: float, vy: float, turn: float) -> None:
    """Find the velocities at the end of a step.

    Args:
        world: The world; contacts and velocities at the beginning of the step.
        found: Number of contacts.
        h: Length of the step (s).
        force: Limit of the drive (N).
        vx: Velocity that the drive wants (m/s).
        vy: Likewise.
        turn: Of the arm (rad/s).
    """
    bodies, rows = world.bodies, world.rows
    _warm_start(world, found, h)
    for _ in range(int(world.arm[ITERATIONS])):
        change = _drive(world, h * force, h, vx, vy)
        if world.arm[HELD] >= 0.0:
            change = max(change, _drag(world, h, turn))
        for row in range(len(bodies) - 2):
            if bodies[row, AWAKE]:
                change = max(change, _floor(bodies, row, h))
        for contact in range(found):
            change = max(change, _contact(bodies, rows, contact))
        if change < CONVERGED:
            break
    _remember(world, found, h)


@compiled
def _warm_start(world: FastWorld, found: int, h: float) -> None:
    """Begin with the forces of the last step."""
    arm, bodies, rows, tip = world.arm, world.bodies, world.rows, len(world.bodies) - 2
    share = bodies[tip, BY_MASS] * h
    bodies[tip, VX] += (arm[DRIVE_X] + arm[DRAG_X]) * share
    bodies[tip, VY] += (arm[DRIVE_Y] + arm[DRAG_Y]) * share
    for row in range(tip):
        if bodies[row, AWAKE]:
            bodies[row, VX] += bodies[row, FLOOR_X] * h * bodies[row, BY_MASS]
            bodies[row, VY] += bodies[row, FLOOR_Y] * h * bodies[row, BY_MASS]
            bodies[row, SPIN] += bodies[row, FLOOR_TORQUE] * h * bodies[row, BY_INERTIA]
        else:
            bodies[row, FLOOR_X] = bodies[row, FLOOR_Y] = bodies[row, FLOOR_TORQUE] = 0.0
    for contact in range(found):
        if rows[contact, IMPULSE_N] != 0.0 or rows[contact, IMPULSE_T] != 0.0:
            _push(bodies, rows, contact, rows[contact, IMPULSE_N], rows[contact, IMPULSE_T])


@compiled
def _remember(world: FastWorld, found: int, h: float) -> None:
    world.arm[STEPS] += 1.0
    rows = world.rows
    for contact in range(found):
        if rows[contact, TOUCHER_A] >= 0.0 and rows[contact, IMPULSE_N] > 0.0:
            a, b = int(rows[contact, TOUCHER_A]), int(rows[contact, TOUCHER_B])
            low, high = min(a, b), max(a, b)
            world.remembered[low, high, 0] = rows[contact, IMPULSE_N] / h
            world.remembered[low, high, 1] = rows[contact, IMPULSE_T] / h
            world.remembered[low, high, 2] = world.arm[STEPS]


@compiled
def _push(bodies: FloatArray, rows: FloatArray, contact: int, normal: float, tangent: float) -> None:
    """Apply an impulse of a contact (N s), along its normal and across."""
    a, b = int(rows[contact, BODY_A]), int(rows[contact, BODY_B])
    px = rows[contact, NORMAL_X] * normal - rows[contact, NORMAL_Y] * tangent
    py = rows[contact, NORMAL_Y] * normal + rows[contact, NORMAL_X] * tangent
    bodies[a, VX] -= px * bodies[a, BY_MASS]
    bodies[a, VY] -= py * bodies[a, BY_MASS]
    bodies[a, SPIN] -= rows[contact, LEVER_A] * tangent * bodies[a, BY_INERTIA]
    bodies[b, VX] += px * bodies[b, BY_MASS]
    bodies[b, VY] += py * bodies[b, BY_MASS]
    bodies[b, SPIN] -= rows[contact, LEVER_B] * tangent * bodies[b, BY_INERTIA]


@compiled
def _contact(bodies: FloatArray, rows: FloatArray, contact: int) -> float:
    """Solve one contact; the change of velocity (m/s)."""
    a, b = int(rows[contact, BODY_A]), int(rows[contact, BODY_B])
    dx, dy = bodies[b, VX] - bodies[a, VX], bodies[b, VY] - bodies[a, VY]
    away = dx * rows[contact, NORMAL_X] + dy * rows[contact, NORMAL_Y] + rows[contact, GIVEN_N]
    normal = max(0.0, rows[contact, IMPULSE_N] + (rows[contact, LEAST] - away) * rows[contact, MASS_N])
    across = dy * rows[contact, NORMAL_X] - dx * rows[contact, NORMAL_Y] + rows[contact, GIVEN_T]
    across -= rows[contact, LEVER_A] * bodies[a, SPIN] + rows[contact, LEVER_B] * bodies[b, SPIN]
    most = rows[contact, FRICTION] * normal
    tangent = min(most, max(-most, rows[contact, IMPULSE_T] - across * rows[contact, MASS_T]))
    by_normal, by_tangent = normal - rows[contact, IMPULSE_N], tangent - rows[contact, IMPULSE_T]
    if by_normal == 0.0 and by_tangent == 0.0:
        return 0.0
    rows[contact, IMPULSE_N], rows[contact, IMPULSE_T] = normal, tangent
    _push(bodies, rows, contact, by_normal, by_tangent)
    return float(max(abs(by_normal) / rows[contact, MASS_N], abs(by_tangent) / rows[contact, MASS_T]))


@compiled
def _floor(bodies: FloatArray, row: int, h: float) -> float:
    """Friction with the board: drive the velocity to 0 as far as the limit surface allows."""
    lever, mass = bodies[row, FRICTION_LEVER], bodies[row, MASS]
    turning = min(bodies[row, INERTIA], mass * lever * lever)
    fx = bodies[row, FLOOR_X] - mass * bodies[row, VX] / h
    fy = bodies[row, FLOOR_Y] - mass * bodies[row, VY] / h
    torque = bodies[row, FLOOR_TORQUE] - turning * bodies[row, SPIN] / h
    size = math.sqrt(fx * fx + fy * fy + (torque / lever) ** 2)
    if size > bodies[row, MOST_FRICTION]:
        scale = bodies[row, MOST_FRICTION] / size
        fx, fy, torque = fx * scale, fy * scale, torque * scale
    dx = (fx - bodies[row, FLOOR_X]) * h * bodies[row, BY_MASS]
    dy = (fy - bodies[row, FLOOR_Y]) * h * bodies[row, BY_MASS]
    spin = (torque - bodies[row, FLOOR_TORQUE]) * h * bodies[row, BY_INERTIA]
    bodies[row, VX] += dx
    bodies[row, VY] += dy
    bodies[row, SPIN] += spin
    bodies[row, FLOOR_X], bodies[row, FLOOR_Y], bodies[row, FLOOR_TORQUE] = fx, fy, torque
    return float(max(abs(dx), abs(dy), abs(spin) * lever))


@compiled
def _drive(world: FastWorld, most: float, h: float, vx: float, vy: float) -> float:
    """Draw the arm to the velocity that it is to have, with an impulse of at most ``most`` (N s)."""
    tip = len(world.bodies) - 2
    mass = 1.0 / world.bodies[tip, BY_MASS]
    wanted_x, wanted_y = mass * (vx - world.bodies[tip, VX]), mass * (vy - world.bodies[tip, VY])
    return _push_tip(world, most, h, (DRIVE_X, DRIVE_Y), (wanted_x, wanted_y))


@compiled
def _drag(world: FastWorld, h: float, turn: float) -> float:
    """Friction of what is held with the board, as far as the board goes."""
    arm, tip, held = world.arm, len(world.bodies) - 2, int(world.arm[HELD])
    mass, most = 1.0 / world.bodies[tip, BY_MASS], drag_force(world) * h
    vx = world.bodies[tip, VX] - turn * (world.bodies[held, Y] - arm[BODY_Y])
    vy = world.bodies[tip, VY] + turn * (world.bodies[held, X] - arm[BODY_X])
    return _push_tip(world, most, h, (DRAG_X, DRAG_Y), (-mass * vx, -mass * vy))


@compiled
def _push_tip(world: FastWorld, most: float, h: float, force: tuple[int, int], wanted: tuple[float, float]) -> float:
    """Add an impulse on the fingertip to that of the iterations before, both together at most ``most``; how far that moved it.

    Args:
        world: The world.
        most: Of the impulse (N s).
        h: Of the step (s).
        force: Fields of the arm with the force that the impulse so far stands for (N).
        wanted: What is to be added (N s).
    """
    arm, tip = world.arm, len(world.bodies) - 2
    mass = 1.0 / world.bodies[tip, BY_MASS]
    px, py = arm[force[0]] * h + wanted[0], arm[force[1]] * h + wanted[1]
    size = length(px, py)
    if size > most:
        px, py = px * most / size, py * most / size
    dx, dy = (px - arm[force[0]] * h) / mass, (py - arm[force[1]] * h) / mass
    world.bodies[tip, VX] += dx
    world.bodies[tip, VY] += dy
    arm[force[0]], arm[force[1]] = px / h, py / h
    return float(max(abs(dx), abs(dy)))
