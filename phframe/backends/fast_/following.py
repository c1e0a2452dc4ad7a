"""One motion: the legs of a trajectory, then waiting for rest."""

from __future__ import annotations

import math

from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.fingers import drag_force, forget_between, grip, note_between, told_opening
from phframe.backends.fast_.layout import (
    ARM_VX,
    ARM_VY,
    AT,
    AT_OPENING,
    AT_X,
    AT_Y,
    AT_YAW,
    BEFORE,
    BODY_X,
    BODY_Y,
    BRAKING,
    CALM,
    CARRIER_X,
    CARRIER_Y,
    CARRIER_YAW,
    CAUSE,
    COMMAND,
    DONE,
    DRIVE_X,
    DRIVE_Y,
    FOLLOWED,
    FOLLOWING,
    FORCE_LIMIT,
    FROM_X,
    FROM_Y,
    FROM_YAW,
    HELD,
    JUMPED,
    LARGEST_LAG,
    LEG,
    LEG_TIME,
    LONGEST_STEP,
    NO_CAUSE,
    OPENING,
    OWN_X,
    OWN_Y,
    PARKED,
    PRESENT,
    RADIUS,
    RESTING,
    SATURATED,
    SETTLE_BEGAN,
    SETTLE_HOLD,
    SETTLE_SPEED,
    SETTLE_TIMEOUT,
    SETTLED,
    SETTLING,
    SPIN,
    STAGE,
    STALL_LAG,
    STALLED,
    STEP,
    STEPS,
    TIME,
    VX,
    VY,
    YAW,
    FastPath,
    FastRun,
    FastWorld,
    X,
)
from phframe.backends.fast_.noting import note_contacts, note_force, note_free, refuse_speed, strength
from phframe.backends.fast_.stepping import LEVER, free_time, place, rest, step

TINY = 1e-12
"""No leg, and no rest of one, is that short (s)."""
ON_COURSE = 1e-5
"""An arm that lags less than this (m) is where it is told to be."""
SHORTEST = 0.25
"""No step is shorter than this fraction of the longest, for what moves faster than the arm."""


@compiled
def begin(world: FastWorld, path: FastPath, run: FastRun) -> None:
    """Put a parked arm where the trajectory begins."""
    if world.arm[HELD] < 0.0 and world.arm[PARKED] == 1.0:
        place(world, path.legs[0, AT_X], path.legs[0, AT_Y], path.legs[0, AT_YAW], path.legs[0, AT_OPENING])
        world.arm[COMMAND] = path.legs[0, AT_OPENING]
        world.arm[PARKED] = 0.0
    _begin_leg(world, run)


@compiled
def advance(world: FastWorld, path: FastPath, run: FastRun, until: float) -> None:
    """Go on until a time (s) or the end of the motion."""
    figures = run.figures
    while figures[STAGE] != DONE:
        figures[BEFORE], figures[JUMPED] = figures[TIME], 0.0
        if figures[STAGE] == FOLLOWING:
            _follow(world, path, run)
        elif figures[STAGE] == SETTLING:
            _settle(world, path, run)
        if figures[TIME] >= until and figures[TIME] > figures[BEFORE]:
            return


@compiled
def _follow(world: FastWorld, path: FastPath, run: FastRun) -> None:
    """A jump or a step along the leg, or on to the next leg."""
    figures, leg = run.figures, int(run.figures[LEG])
    if leg == len(path.legs) - 1 or figures[STALLED] == 1.0 or figures[CAUSE] != NO_CAUSE:
        _halt(world, path, run)
        return
    left = path.legs[leg + 1, AT] - path.legs[leg, AT] - figures[LEG_TIME]
    if left <= TINY:
        figures[LEG] += 1.0
        _begin_leg(world, run)
        return
    if figures[LEG_TIME] == 0.0:
        _begin_closing(world, path, leg)
    speed = leg_speed(path, run, leg)
    longest = _longest_step(world, speed)
    if not _jump(world, path, run, leg, speed, left, longest):
        _step_along(world, path, run, leg, left, longest)


@compiled
def _begin_leg(world: FastWorld, run: FastRun) -> None:
    figures, arm = run.figures, world.arm
    figures[LEG_TIME] = 0.0
    figures[FROM_X], figures[FROM_Y], figures[FROM_YAW] = arm[CARRIER_X], arm[CARRIER_Y], arm[CARRIER_YAW]


@compiled
def _begin_closing(world: FastWorld, path: FastPath, leg: int) -> None:
    if path.legs[leg + 1, AT_OPENING] < path.legs[leg, AT_OPENING] and world.arm[HELD] < 0.0:
        note_between(world)
    else:
        forget_between(world)


@compiled
def brake_time(path: FastPath, run: FastRun, leg: int) -> float:
    """How long the arm brakes at the end of a leg (s): with a trapezoid's flank, at the leg's length and duration."""
    duration = path.legs[leg + 1, AT] - path.legs[leg, AT]
    braking = path.limits[BRAKING]
    way = length(path.legs[leg + 1, AT_X] - run.figures[FROM_X], path.legs[leg + 1, AT_Y] - run.figures[FROM_Y])
    if braking == 0.0 or way == 0.0:
        return 0.0
    rest_of = duration**2 - 2.0 * way / braking
    return float(duration - math.sqrt(rest_of) if rest_of > 0.0 else duration)


@compiled
def progress(path: FastPath, run: FastRun, leg: int, time: float) -> float:
    """The fraction of a leg behind the carrier at a time since the leg began (s)."""
    duration, braking = path.legs[leg + 1, AT] - path.legs[leg, AT], brake_time(path, run, leg)
    speed = 1.0 / (duration - braking / 2.0)
    if time >= duration:
        return 1.0
    if time <= duration - braking:
        return float(time * speed)
    return float(1.0 - speed * (duration - time) ** 2 / (2.0 * braking))


@compiled
def leg_speed(path: FastPath, run: FastRun, leg: int) -> float:
    """How fast any point of the arm moves that matters to a step (m/s)."""
    figures = run.figures
    way = length(path.legs[leg + 1, AT_X] - figures[FROM_X], path.legs[leg + 1, AT_Y] - figures[FROM_Y])
    way += LEVER * abs(path.legs[leg + 1, AT_YAW] - figures[FROM_YAW])
    way += abs(path.legs[leg + 1, AT_OPENING] - path.legs[leg, AT_OPENING]) / 2.0
    return float(way / (path.legs[leg + 1, AT] - path.legs[leg, AT] - brake_time(path, run, leg) / 2.0))


@compiled
def _longest_step(world: FastWorld, speed: float) -> float:
    """So that nothing moves farther in a step than it may (s)."""
    fastest = speed
    for row in range(len(world.bodies) - 2):
        fastest = max(fastest, length(world.bodies[row, VX], world.bodies[row, VY]) * SHORTEST)
    return float(min(world.arm[LONGEST_STEP], world.arm[STEP] / fastest) if fastest > 0.0 else world.arm[LONGEST_STEP])


@compiled
def pose_at(path: FastPath, run: FastRun, leg: int, time: float) -> tuple[float, float, float]:
    """The carrier's pose at a time since the leg began (s)."""
    figures, done = run.figures, progress(path, run, leg, time)
    if done >= 1.0:
        return path.legs[leg + 1, AT_X], path.legs[leg + 1, AT_Y], path.legs[leg + 1, AT_YAW]
    return (
        figures[FROM_X] + done * (path.legs[leg + 1, AT_X] - figures[FROM_X]),
        figures[FROM_Y] + done * (path.legs[leg + 1, AT_Y] - figures[FROM_Y]),
        figures[FROM_YAW] + done * (path.legs[leg + 1, AT_YAW] - figures[FROM_YAW]),
    )


@compiled
def _opening_at(world: FastWorld, path: FastPath, leg: int, time: float) -> float:
    """The opening that the fingers come to (m)."""
    first, last = path.legs[leg, AT_OPENING], path.legs[leg + 1, AT_OPENING]
    if first == last:
        return float(world.arm[OPENING])
    return told_opening(world, first + (last - first) * min(1.0, time / (path.legs[leg + 1, AT] - path.legs[leg, AT])))


@compiled
def _jump(world: FastWorld, path: FastPath, run: FastRun, leg: int, speed: float, left: float, longest: float) -> bool:
    """While nothing moves, go as far as the arm meets nothing, if that is farther than a step."""
    figures, arm = run.figures, world.arm
    lag = length(arm[CARRIER_X] - arm[BODY_X], arm[CARRIER_Y] - arm[BODY_Y])
    force = drag_force(world) if speed > 0.0 else 0.0
    if arm[RESTING] == 0.0 or lag > ON_COURSE or force >= strength(path):
        return False
    fastest = speed + _whirl(world, path, run, leg)
    free = free_time(world, fastest)
    if free < left and free <= longest:
        return False
    time = figures[LEG_TIME] + min(free, left)
    if free >= left:
        time = path.legs[leg + 1, AT] - path.legs[leg, AT]
    x, y, yaw = pose_at(path, run, leg, time)
    place(world, x, y, yaw, _jumped_opening(world, path, leg, time))
    note_free(run, force, time - figures[LEG_TIME])
    figures[TIME] += time - figures[LEG_TIME]
    figures[LEG_TIME], figures[JUMPED] = time, 1.0
    rest(world)
    return True


@compiled
def _jumped_opening(world: FastWorld, path: FastPath, leg: int, time: float) -> float:
    opening = _opening_at(world, path, leg, time)
    if world.arm[HELD] < 0.0:
        world.arm[COMMAND] = opening
    return opening


@compiled
def _whirl(world: FastWorld, path: FastPath, run: FastRun, leg: int) -> float:
    """What turning adds to the speed of the arm's farthest corner (m/s)."""
    turn = abs(path.legs[leg + 1, AT_YAW] - run.figures[FROM_YAW])
    if turn == 0.0:
        return 0.0
    farthest = 0.0
    for row in range(len(world.corners)):
        farthest = max(farthest, length(world.corners[row, OWN_X], world.corners[row, OWN_Y]))
    duration = path.legs[leg + 1, AT] - path.legs[leg, AT] - brake_time(path, run, leg) / 2.0
    return float((farthest + 0.1) * turn / duration)


@compiled
def _step_along(world: FastWorld, path: FastPath, run: FastRun, leg: int, left: float, longest: float) -> None:
    figures = run.figures
    cruise = left - brake_time(path, run, leg)
    span = cruise if cruise > TINY else left
    h = span / math.ceil(span / longest - 1e-9)
    time = figures[LEG_TIME] + h
    if left - h <= TINY:
        time = path.legs[leg + 1, AT] - path.legs[leg, AT]
    x, y, yaw = pose_at(path, run, leg, time)
    opening = _opening_at(world, path, leg, time)
    found = step(world, h, x, y, yaw, opening, path.limits[FORCE_LIMIT])
    if world.arm[HELD] < 0.0:
        world.arm[COMMAND] = opening
        grip(world, path.legs[leg + 1, AT_OPENING])
    figures[TIME] += h
    figures[LEG_TIME] = time
    _note(world, path, run, found, h, leg)


@compiled
def _note(world: FastWorld, path: FastPath, run: FastRun, found: int, h: float, leg: int) -> None:
    """What a step means to the motion."""
    figures, arm = run.figures, world.arm
    spill(world)
    rest(world)
    note_contacts(world, path, run, found, leg, figures[TIME] - h / 2.0)
    note_force(world, path, run, h)
    lag = length(arm[CARRIER_X] - arm[BODY_X], arm[CARRIER_Y] - arm[BODY_Y])
    figures[LARGEST_LAG] = max(figures[LARGEST_LAG], lag)
    if arm[SATURATED] == 1.0 and lag > world.arm[STALL_LAG] and figures[STAGE] == FOLLOWING:
        figures[STALLED] = 1.0 if figures[CAUSE] == NO_CAUSE else 0.0
    refuse_speed(world, run)


@compiled
def spill(world: FastWorld) -> None:
    """Take what has left the board at the mouth out of the world."""
    for row in range(len(world.bodies) - 2):
        if world.bodies[row, PRESENT] and world.bodies[row, X] < 0.0 and row != int(world.arm[HELD]):
            world.bodies[row, PRESENT] = 0
            world.bodies[row, VX] = world.bodies[row, VY] = world.bodies[row, SPIN] = 0.0


@compiled
def _halt(world: FastWorld, path: FastPath, run: FastRun) -> None:
    """Stand still, and where the arm could not follow, forget where it should have been."""
    figures, arm = run.figures, world.arm
    arm[ARM_VX] = arm[ARM_VY] = arm[SATURATED] = arm[DRIVE_X] = arm[DRIVE_Y] = 0.0
    arm[STEPS] += 1.0  # no contact presses on, as those of the last step would
    if figures[STALLED] == 1.0 or figures[CAUSE] != NO_CAUSE:
        arm[CARRIER_X], arm[CARRIER_Y], arm[CARRIER_YAW] = arm[BODY_X], arm[BODY_Y], arm[YAW]
    figures[FOLLOWED] = figures[SETTLE_BEGAN] = figures[TIME]
    figures[STAGE] = SETTLING if path.limits[SETTLE_SPEED] > 0.0 else DONE
    figures[SETTLED] = 1.0


@compiled
def _settle(world: FastWorld, path: FastPath, run: FastRun) -> None:
    """Wait until everything has been calm for long enough."""
    figures, arm, limits = run.figures, world.arm, path.limits
    if rest(world) or figures[CALM] >= limits[SETTLE_HOLD]:
        _come_to_rest(world)
        figures[STAGE] = DONE
        return
    if figures[TIME] - figures[SETTLE_BEGAN] >= limits[SETTLE_TIMEOUT]:
        figures[STAGE], figures[SETTLED] = DONE, 0.0
        return
    h = _longest_step(world, 0.0)
    found = step(world, h, arm[CARRIER_X], arm[CARRIER_Y], arm[CARRIER_YAW], arm[OPENING], limits[FORCE_LIMIT])
    figures[TIME] += h
    _note(world, path, run, found, h, len(path.legs) - 1 - 1)
    figures[CALM] = figures[CALM] + h if _calm(world, limits[SETTLE_SPEED]) else 0.0


@compiled
def _calm(world: FastWorld, speed: float) -> bool:
    for row in range(len(world.bodies) - 2):
        of_rim = abs(world.bodies[row, SPIN]) * world.bodies[row, RADIUS]
        if length(world.bodies[row, VX], world.bodies[row, VY]) + of_rim >= speed:
            return False
    return True


@compiled
def _come_to_rest(world: FastWorld) -> None:
    for row in range(len(world.bodies) - 2):
        world.bodies[row, VX] = world.bodies[row, VY] = world.bodies[row, SPIN] = 0.0
    world.arm[RESTING] = 1.0
