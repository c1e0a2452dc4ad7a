"""A MuJoCo world caught in motion, for planners that steer at control level."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from phframe.backends.mujoco_.world import World
from phframe.core import Floats, State, Value

EVERYTHING = mujoco.mjtState.mjSTATE_INTEGRATION
"""All that the engine's next step depends on."""


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot(Value):
    """A state, and the engine's own account of it.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        engine: MuJoCo's integration state, speeds, commands and warm start included.
    """

    state: State
    engine: Floats

    def __post_init__(self) -> None:
        self._freeze("engine")


def take_snapshot(world: World) -> Snapshot:
    """The world as it is now."""
    mj, engine = world.model.mj, np.empty(mujoco.mj_stateSize(world.model.mj, EVERYTHING))
    state = world.read_state()
    mujoco.mj_getState(mj, world.data, engine, EVERYTHING)
    return Snapshot(state, engine)


def put_back(world: World, snapshot: Snapshot) -> None:
    """Make the world be what it was when the snapshot was taken."""
    world.restore(snapshot.state)
    mujoco.mj_setState(world.model.mj, world.data, snapshot.engine, EVERYTHING)
