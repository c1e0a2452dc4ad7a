"""Many motions in one call of the compiled code."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.backends.fast_.engine import run_all
from phframe.backends.fast_.layout import RUN_FIELDS, FastPath, FastRun, FastWorld
from phframe.backends.fast_.state import StateReader, legs_of
from phframe.core import GripperTrajectory, Settle, State, Stop, Transition

Braked = tuple[GripperTrajectory, float | None]
"""A trajectory, and how the arm brakes at its corners (m/s^2)."""


def run_many(
    world: FastWorld,
    run: FastRun,
    reader: StateReader,
    states: Sequence[State],
    paths: Sequence[Braked],
    settle: Settle | None,
    stop: Stop | None,
) -> list[Transition]:
    """What each trajectory makes of its state.

    Args:
        world: Room for a world.
        run: Room for a motion.
        reader: Turns states into arrays and back.
        states: One for each path.
        paths: The paths.
        settle: Wait for rest after each; None: do not.
        stop: When to end each early.
    """
    if not states:
        return []
    bodies, arms = np.array([reader.bodies(s) for s in states]), np.array([reader.arm(s) for s in states])
    told = np.zeros((len(states), RUN_FIELDS + run.events.size))
    limits = np.array([reader.limits(t.force_limit, stop, braking, settle) for t, braking in paths])
    first = np.cumsum([0, *(len(trajectory.times) for trajectory, _ in paths)])
    path = FastPath(np.concatenate([legs_of(trajectory) for trajectory, _ in paths]), limits)
    run_all(world, run, path, first, bodies, arms, told)
    return [
        Transition(
            reader.state(bodies[row], arms[row], states[row]),
            reader.motion(told[row, :RUN_FIELDS], told[row, RUN_FIELDS:].reshape(-1, 4), trajectory),
        )
        for row, (trajectory, _) in enumerate(paths)
    ]
