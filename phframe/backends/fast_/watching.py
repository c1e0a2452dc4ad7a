"""Lets somebody look on while a motion runs."""

from __future__ import annotations

import math

from phframe.backends.fast_ import layout
from phframe.backends.fast_.engine import go_on
from phframe.backends.fast_.following import pose_at
from phframe.backends.fast_.layout import FastPath, FastRun, FastWorld
from phframe.backends.fast_.state import StateReader
from phframe.core import FloatArray, State, Watch


def go_on_watched(
    world: FastWorld,
    path: FastPath,
    run: FastRun,
    watch: Watch,
    reader: StateReader,
    before: State,
) -> None:
    """Go on to the end of a motion that has begun; a look at the end of the first step after each period, and within jumps.

    Args:
        world: The world, at the beginning of the motion.
        path: Where the arm goes.
        run: The motion.
        watch: Who looks on.
        reader: Turns arrays into states.
        before: The state that was restored.
    """
    figures = run.figures
    watch.look(0.0, reader.state(world.bodies, world.arm, before))
    look, figures[layout.STAGE] = 0, layout.FOLLOWING
    while figures[layout.STAGE] != layout.DONE:
        go_on(world, path, run, look == 0, max(look, 1) * watch.period)
        look = max(look, 1)
        if figures[layout.JUMPED] == 1.0:
            while look * watch.period < figures[layout.TIME]:
                watch.look(look * watch.period, _within_jump(world, path, run, look * watch.period, reader, before))
                look += 1
        time = float(figures[layout.TIME])
        if time >= look * watch.period and figures[layout.STAGE] != layout.DONE:
            watch.look(time, reader.state(world.bodies, world.arm, before))
            look = math.floor(time / watch.period) + 1
    watch.look(float(figures[layout.TIME]), reader.state(world.bodies, world.arm, before))


def _within_jump(
    world: FastWorld, path: FastPath, run: FastRun, time: float, reader: StateReader, before: State
) -> State:
    """The world as it was at a time (s) within the jump that ended now."""
    figures = run.figures
    in_leg = float(figures[layout.LEG_TIME] - (figures[layout.TIME] - time))
    x, y, yaw = pose_at(path, run, int(figures[layout.LEG]), in_leg)
    arm = world.arm.copy()
    arm[layout.BODY_X : layout.YAW + 1] = x, y, yaw
    return reader.state(_carried(world, arm), arm, before)


def _carried(world: FastWorld, arm: FloatArray) -> FloatArray:
    """The bodies, with what is held where the arm is."""
    bodies, held = world.bodies.copy(), int(arm[layout.HELD])
    if held >= 0:
        cosine, sine = math.cos(arm[layout.YAW]), math.sin(arm[layout.YAW])
        x, y = float(arm[layout.GRIP_X]), float(arm[layout.GRIP_Y])
        bodies[held, layout.X] = arm[layout.BODY_X] + cosine * x - sine * y
        bodies[held, layout.Y] = arm[layout.BODY_Y] + sine * x + cosine * y
        bodies[held, layout.TURN] = arm[layout.YAW] + arm[layout.GRIP_YAW]
    return bodies
