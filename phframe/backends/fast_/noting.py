"""What is told of a motion: contacts of the arm, the force on it, why it ended."""

from __future__ import annotations

from phframe.backends.contract import TOP_SPEED
from phframe.backends.fast_.compiled import compiled, length
from phframe.backends.fast_.layout import (
    BODY_A,
    BODY_B,
    CAUSE,
    CAUSE_BODY,
    CAUSE_FORCE,
    CONTACT_CAUSE,
    DIVERGED,
    DONE,
    DRIVE_X,
    DRIVE_Y,
    EVENTS,
    FOLLOWING,
    FORCE,
    FORCE_CAUSE,
    FORCE_LIMIT,
    IMPULSE_N,
    LARGEST_FORCE,
    NO_CAUSE,
    PHASE,
    RADIUS,
    SPIN,
    STAGE,
    STOP_FORCE,
    STOPS,
    TOUCHER_A,
    TOUCHER_B,
    VX,
    VY,
    WINDOW,
    WINDOW_STEPS,
    FastPath,
    FastRun,
    FastWorld,
)
from phframe.core import FORCE_WINDOW


@compiled
def note_contacts(world: FastWorld, path: FastPath, run: FastRun, found: int, leg: int, time: float) -> None:
    """Note what the arm pressed on in a step, once in every phase, and whether that ends the motion."""
    tip, parts = len(world.bodies) - 2, len(world.parts)
    rows = world.rows
    for contact in range(found):
        if rows[contact, IMPULSE_N] <= 0.0:
            continue
        if int(rows[contact, BODY_A]) == tip and int(rows[contact, TOUCHER_A]) < tip + parts:
            _note_contact(path, run, int(rows[contact, TOUCHER_A]) - tip, int(rows[contact, BODY_B]), leg, time)
        elif int(rows[contact, BODY_B]) == tip and rows[contact, TOUCHER_A] < 0.0:
            _note_contact(
                path, run, -1 - int(rows[contact, TOUCHER_B]), tip - 1 - int(rows[contact, TOUCHER_A]), leg, time
            )


@compiled
def _note_contact(path: FastPath, run: FastRun, part: int, what: int, leg: int, time: float) -> None:
    figures, phase = run.figures, int(path.legs[leg, PHASE])
    if figures[STAGE] == FOLLOWING and path.limits[STOPS + what] == 1.0 and figures[CAUSE] == NO_CAUSE:
        figures[CAUSE], figures[CAUSE_BODY] = CONTACT_CAUSE, what
    if run.seen[phase, part, what] == 0:
        run.seen[phase, part, what] = 1
        events, place = run.events, int(figures[EVENTS])
        events[place, 0], events[place, 1], events[place, 2], events[place, 3] = time, part, what, leg
        figures[EVENTS] += 1.0


@compiled
def note_force(world: FastWorld, path: FastPath, run: FastRun, h: float) -> None:
    """Note the mean of the drive's force, and whether that ends the motion."""
    figures, window = run.figures, run.window
    place = int(figures[WINDOW])
    window[place, 0], window[place, 1] = h, h * length(world.arm[DRIVE_X], world.arm[DRIVE_Y])
    figures[WINDOW] = (place + 1) % WINDOW_STEPS
    left, impulse = FORCE_WINDOW, 0.0
    for back in range(WINDOW_STEPS):
        row = (place - back) % WINDOW_STEPS
        if left <= 0.0 or window[row, 0] == 0.0:
            break
        impulse += window[row, 1] * min(1.0, left / window[row, 0])
        left -= window[row, 0]
    figures[FORCE] = impulse / FORCE_WINDOW
    figures[LARGEST_FORCE] = max(figures[LARGEST_FORCE], figures[FORCE])
    if figures[STAGE] == FOLLOWING and figures[FORCE] > path.limits[STOP_FORCE] and figures[CAUSE] == NO_CAUSE:
        figures[CAUSE], figures[CAUSE_FORCE] = FORCE_CAUSE, figures[FORCE]


@compiled
def note_free(run: FastRun, force: float, time: float) -> None:
    """Note the force (N) of a jump of some time (s)."""
    figures, place = run.figures, int(run.figures[WINDOW])
    run.window[place, 0], run.window[place, 1] = time, force * time
    figures[WINDOW] = (place + 1) % WINDOW_STEPS
    if time > 0.0:
        figures[LARGEST_FORCE] = max(figures[LARGEST_FORCE], force)


@compiled
def strength(path: FastPath) -> float:
    """The force (N) from which on the arm stalls or stops."""
    return min(float(path.limits[FORCE_LIMIT]), float(path.limits[STOP_FORCE]))


@compiled
def refuse_speed(world: FastWorld, run: FastRun) -> None:
    """End where a body is nowhere or faster than physics allows."""
    for row in range(len(world.bodies) - 2):
        speed = (
            length(world.bodies[row, VX], world.bodies[row, VY])
            + abs(world.bodies[row, SPIN]) * world.bodies[row, RADIUS]
        )
        if not speed < TOP_SPEED:
            run.figures[DIVERGED], run.figures[STAGE] = row, DONE
