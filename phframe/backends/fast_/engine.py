"""The entry points of the compiled code."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from phframe.backends.fast_.compiled import compile_for, compiled, entry_point, fingerprint
from phframe.backends.fast_.fingers import hold
from phframe.backends.fast_.following import advance, begin
from phframe.backends.fast_.layout import (
    ARM_FIELDS,
    ARM_MASS,
    BY_MASS,
    CAUSE,
    COMMAND,
    DIVERGED,
    FLOOR_X,
    HELD,
    NO_CAUSE,
    RADIUS,
    RUN_FIELDS,
    FastPath,
    FastRun,
    FastWorld,
)
from phframe.core import FloatArray, IntArray


@compiled
def _reset(world: FastWorld, bodies: FloatArray, arm: FloatArray) -> None:
    """Make a world be what the arrays say, with no memory of what ran before."""
    count = len(world.bodies) - 2
    world.bodies[:, :BY_MASS] = 0.0
    world.bodies[:count, : bodies.shape[1]] = bodies
    world.bodies[:, FLOOR_X:RADIUS] = 0.0
    world.bodies[count, BY_MASS] = 1.0 / world.arm[ARM_MASS]
    world.arm[:ARM_FIELDS] = arm
    world.remembered[:, :, 2] = -1.0
    if arm[HELD] >= 0.0:
        hold(world, int(arm[HELD]), arm[COMMAND])


@compiled
def _begin(world: FastWorld, path: FastPath, run: FastRun) -> None:
    run.figures[:] = 0.0
    run.figures[CAUSE], run.figures[DIVERGED] = NO_CAUSE, -1.0
    run.window[:] = 0.0
    run.seen[:] = 0.0
    begin(world, path, run)


def _make_reset(sources: int) -> Callable[[FastWorld, FloatArray, FloatArray], int]:
    @entry_point
    def reset(world: FastWorld, bodies: FloatArray, arm: FloatArray) -> int:
        _reset(world, bodies, arm)
        return sources

    return reset


def _make_go_on(sources: int) -> Callable[[FastWorld, FastPath, FastRun, bool, float], int]:
    @entry_point
    def go_on(world: FastWorld, path: FastPath, run: FastRun, first: bool, until: float) -> int:
        if first:
            _begin(world, path, run)
        advance(world, path, run, until)
        return sources

    return go_on


def _make_run_all(
    sources: int,
) -> Callable[[FastWorld, FastRun, FastPath, IntArray, FloatArray, FloatArray, FloatArray], int]:
    @entry_point
    def run_all(
        world: FastWorld,
        run: FastRun,
        paths: FastPath,
        first: IntArray,
        bodies: FloatArray,
        arms: FloatArray,
        told: FloatArray,
    ) -> int:
        for row in range(len(bodies)):
            path = FastPath(paths.legs[first[row] : first[row + 1]], paths.limits[row])
            _reset(world, bodies[row], arms[row])
            _begin(world, path, run)
            advance(world, path, run, math.inf)
            bodies[row] = world.bodies[: bodies.shape[1], : bodies.shape[2]]
            arms[row] = world.arm[:ARM_FIELDS]
            told[row, :RUN_FIELDS] = run.figures
            for event in range(len(run.events)):
                for column in range(4):
                    told[row, RUN_FIELDS + 4 * event + column] = run.events[event, column]
        return sources

    return run_all


_SOURCES = fingerprint()

reset = _make_reset(_SOURCES)
"""Make a world be what rows of its bodies ``(n, 7)`` and of the arm say: poses, speeds, presence."""
go_on = _make_go_on(_SOURCES)
"""Begin a motion along a path, or go on with it, until a time (s) or its end."""
run_all = _make_run_all(_SOURCES)
"""Many motions, each from its own world; bodies and arms are overwritten by how they end."""


def compile_all(world: FastWorld, run: FastRun) -> None:
    """Compile every entry point, or load it from disk.

    The first time this takes a minute. What the entry points have in common is compiled once per process: one after the other in
    different processes, they would take a minute each.
    """
    count = len(world.bodies) - 2
    bodies, arms, legs = world.bodies[:count, :BY_MASS].copy(), world.arm[:ARM_FIELDS].copy(), np.zeros((1, 1))
    one, many = FastPath(legs, legs[0]), FastPath(legs, legs)
    compile_for(reset, world, bodies, arms)
    compile_for(go_on, world, one, run, True, 0.0)
    compile_for(run_all, world, run, many, np.zeros(1, np.int64), bodies[None], arms[None], legs)
