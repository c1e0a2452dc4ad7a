"""A bare MuJoCo loop that takes a model through what a backend took it through: the same controls, the same steps."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np

from phframe.backends.mujoco_.engine import MujocoEngine
from phframe.backends.mujoco_.physics import MujocoPhysics
from phframe.core import FloatArray

Changes = tuple[tuple[Any, Any], ...]
"""Arrays of the engine that the backend wrote to, and what it wrote."""


@dataclass(slots=True)
class MujocoTape:
    """What a backend did with the engine, one entry for each of its calls of ``mj_step``.

    Attributes:
        controls: What the servos were told.
        counts: How many steps were taken.
        changes: What else was written before, hardly ever anything: limits of servos, what is held, what has spilled.
        end: Where everything was in the end, ``qpos``.
    """

    controls: list[FloatArray] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)
    changes: list[Changes] = field(default_factory=list)
    end: FloatArray = field(default_factory=lambda: np.zeros(0))

    @property
    def steps(self) -> int:
        """Of the engine."""
        return sum(self.counts)


def note(physics: MujocoPhysics, run: Callable[[], object]) -> MujocoTape:
    """Run something on a backend, and note what it does with the engine."""
    tape, step = MujocoTape(), mujoco.mj_step
    model, data = _engine(physics)
    watched = (model.actuator_forcerange, model.geom_conaffinity, data.qpos, data.qvel, data.xfrc_applied)
    known = [array.copy() for array in watched]

    def noting(mj: Any, now: Any, nstep: int = 1) -> None:
        changed = ((array, array.copy()) for array, old in zip(watched, known, strict=True) if (array != old).any())
        tape.changes.append(tuple(changed))
        tape.controls.append(now.ctrl.copy())
        tape.counts.append(nstep)
        step(mj, now, nstep)
        known[:] = [array.copy() for array in watched]

    mujoco.mj_step = noting
    try:
        run()
    finally:
        mujoco.mj_step = step
    tape.end = data.qpos.copy()
    return tape


def play(physics: MujocoPhysics, tape: MujocoTape) -> float:
    """Seconds of the bare loop, from where the backend's world is; it ends where the backend did, bit by bit."""
    model, data = _engine(physics)
    ctrl, step, entries = data.ctrl, mujoco.mj_step, [*zip(tape.controls, tape.counts, tape.changes, strict=True)]
    began = time.process_time()
    for control, count, changes in entries:
        for array, values in changes:
            array[:] = values
        ctrl[:] = control
        step(model, data, count)
    seconds = time.process_time() - began
    assert data.qpos.tobytes() == tape.end.tobytes(), "the bare loop ends where the backend did"
    return seconds


def _engine(physics: MujocoPhysics) -> tuple[Any, Any]:
    engine = physics.world.engine
    assert isinstance(engine, MujocoEngine)
    return engine.model.mj, engine.data
