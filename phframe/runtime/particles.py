"""Samples of what the world may be, given what is declared of the noise: other positions, and other friction with the board."""

from __future__ import annotations

from dataclasses import replace
from types import TracebackType
from typing import Self

from phframe.core import ArmShape, Particle, State
from phframe.runtime.noise import PARTICLES, Noise
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.sensor import Sensor
from phframe.runtime.world import WorldSpec


class Particles:
    """Draws samples. Use it in a ``with``.

    Friction does not change while an episode runs, so every sample keeps its own; positions are drawn anew each time.

    Args:
        spec: The world that is planned in, as the planner believes it.
        noise: How far that may be off.
        shape: Of the arm.
        seed: Of the episode.
    """

    def __init__(self, spec: WorldSpec, noise: Noise, shape: ArmShape, seed: int) -> None:
        self._spec, self._noise, self._shape = spec, noise, shape
        self._rng = noise.stream(seed, PARTICLES)
        self._worlds: list[tuple[PlanningWorld, Sensor]] = []

    def draw(self, state: State, number: int) -> list[Particle]:
        """So many samples around a state as it is seen."""
        while len(self._worlds) < number:
            self._worlds.append(self._another())
        return [Particle(sensor.see(state), world.apply) for world, sensor in self._worlds[:number]]

    def _another(self) -> tuple[PlanningWorld, Sensor]:
        seed = int(self._rng.integers(2**31))
        scene = self._noise.believed(self._spec.scene, seed)
        return PlanningWorld(replace(self._spec, scene=scene)), Sensor(self._noise, scene, self._shape, seed)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for world, _ in self._worlds:
            world.close()
