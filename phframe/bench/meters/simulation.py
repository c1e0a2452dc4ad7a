"""What simulating an episode costs beside a bare loop of the same engine: same model, same controls, same steps."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from phframe.core import Episode, Physics, Settle, State, Stop, Trajectory
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec

BARE: Mapping[str, str] = {
    "mujoco": "phframe.bench.meters.bare_mujoco",
    "pybullet": "phframe.bench.meters.bare_pybullet",
}
"""Where the bare loop of an engine is: a module with ``note`` and ``play``."""
BARS: Mapping[str, float] = {"mujoco": 1.15, "pybullet": 1.3}
"""What simulating an episode may cost at most, over the bare loop."""
REPEATS = 5


@dataclass(frozen=True, slots=True)
class Simulation:
    """The simulation of one episode.

    Attributes:
        scene: Its name.
        backend: Its name.
        simulated: Processor time of the backend (s), for every trajectory the least of some repeats; other programs on
            the machine disturb it least.
        bare: Processor time of the bare loop (s), likewise, in turns with the backend.
        steps: Steps of the engine, of either.
    """

    scene: str
    backend: str
    simulated: float
    bare: float
    steps: int

    @property
    def ratio(self) -> float:
        """The backend over the bare loop."""
        return self.simulated / self.bare


def measure_simulation(name: str, backend: str) -> Simulation:
    """Carry out an episode's trajectories again and again, with the backend and with its bare engine."""
    episode = solve(name, backend=backend)
    simulated, bare, steps = 0.0, 0.0, 0
    with PlanningWorld(WorldSpec(episode.scene, backend)) as world:
        for before, trajectory in _driven(episode):
            times = _one(world.physics, import_module(BARE[backend]), before, trajectory)
            simulated, bare, steps = simulated + times[0], bare + times[1], steps + times[2]
    return Simulation(name, backend, simulated, bare, steps)


def _driven(episode: Episode) -> list[tuple[State, Trajectory]]:
    """What the episode's arm drove, and from where; of an episode without a step, nothing."""
    return [(step.before, step.trajectory) for step in episode.steps]


def _one(physics: Physics[Any], engine: Any, before: State, trajectory: Trajectory) -> tuple[float, float, int]:
    """Seconds of the backend and of the bare loop for one trajectory, and the steps of either."""

    def execute() -> float:
        began = time.process_time()
        physics.execute(trajectory, settle=Settle(), stop=Stop(wall=True))
        return time.process_time() - began

    physics.restore(before)
    tape = engine.note(physics, execute)
    simulated, bare = [], []
    for _ in range(REPEATS):
        physics.restore(before)
        simulated.append(execute())
        physics.restore(before)
        bare.append(engine.play(physics, tape))
    return min(simulated), min(bare), tape.steps
