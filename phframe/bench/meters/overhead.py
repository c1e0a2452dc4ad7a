"""What planning costs beside a bare engine loop that takes the same bodies through the same motions."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.backends.pymunk_ import chipmunk
from phframe.backends.pymunk_.gripper import place_arm
from phframe.backends.pymunk_.physics import PymunkPhysics
from phframe.backends.pymunk_.world import ShelfSpace, build_world, lay_floor
from phframe.bench.meters.tasks import retrieval_task
from phframe.core import Action, State, Stop, Transition, Watch
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec

REPEATS = 5


@dataclass(frozen=True, slots=True)
class Overhead:
    """One scene.

    Attributes:
        scene: Its name.
        planning: Wall time of planning (s), the least of some repeats.
        bare: Wall time of the bare loop over all motions that were simulated, from end to end (s), likewise.
        bare_stepped: Of just the steps that planning took, timed in place (s): it fast-forwards while nothing is touched.
        steps: Steps of those motions.
        stepped: Steps that planning really took.
    """

    scene: str
    planning: float
    bare: float
    bare_stepped: float
    steps: int
    stepped: int

    @property
    def ratio(self) -> float:
        """Planning over the bare loop that simulates the same motions."""
        return self.planning / self.bare

    @property
    def strict_ratio(self) -> float:
        """Planning over the bare loop that takes only the steps that planning took."""
        return self.planning / self.bare_stepped


def measure(name: str, planner_name: str = "phia") -> Overhead:
    """Plan a scene again and again, and do with bare pymunk what planning did with it."""
    planner, spec = create(Kind.PLANNER, planner_name), WorldSpec(find_scene(name))
    with _NotingWorld(spec) as noting:
        stepped, stepping = _time_steps(lambda: planner.plan(retrieval_task(noting)))
    with PlanningWorld(spec) as world:
        planning, bare, steps = np.inf, np.inf, 0
        for _ in range(REPEATS):
            planning = min(planning, planner.plan(retrieval_task(world)).cost.total)
            seconds, steps = _bare(world, noting.applied)
            bare = min(bare, seconds)
            stepping = min(stepping, _time_steps(lambda: planner.plan(retrieval_task(world)))[1])
    return Overhead(name, planning, bare, stepping, steps, stepped)


class _NotingWorld(PlanningWorld):
    """A world that notes what is asked of it."""

    def __init__(self, spec: WorldSpec) -> None:
        super().__init__(spec)
        self.applied: list[tuple[State, Action]] = []

    def apply(self, state: State, action: Action, stop: Stop | None = None, watch: Watch | None = None) -> Transition:
        self.applied.append((state, action))
        return super().apply(state, action, stop, watch)


def _time_steps(work: Callable[[], object]) -> tuple[int, float]:
    """How often Chipmunk is stepped, and how long that takes (s), the clock's own cost taken off."""
    clock, step = time.perf_counter, chipmunk.step
    count, seconds = 0, 0.0

    def timed(space: chipmunk.Handle, dt: float) -> None:
        nonlocal count, seconds
        began = clock()
        step(space, dt)
        seconds += clock() - began
        count += 1

    chipmunk.step = timed
    try:
        work()
    finally:
        chipmunk.step = step
    return count, seconds - count * _clock_cost()


def _clock_cost() -> float:
    """What reading the clock twice adds to a time (s)."""
    clock, times = time.perf_counter, []
    for _ in range(1000):
        began = clock()
        times.append(clock() - began)
    return float(np.median(times))


def _bare(world: PlanningWorld, applied: Sequence[tuple[State, Action]]) -> tuple[float, int]:
    """Seconds and steps of a loop that does nothing but step, every object with its friction; building is not counted."""
    physics: PymunkPhysics = world.physics  # type: ignore[assignment]
    seconds, steps, step = 0.0, 0, physics.options.step
    for state, action in applied:
        built = build_world(physics.model, state)
        legs = _legs(world, state, action, step)
        place_arm(built, action.path.poses[0].tolist())
        chipmunk.set_max_force(built.arm.drive, world.arm.force_limit)
        for item in built.items.values():
            lay_floor(built, item)
        seconds += _loop(built, legs, step)
        steps += sum(count for _, count in legs)
    return seconds, steps


def _legs(world: PlanningWorld, state: State, action: Action, step: float) -> list[tuple[tuple[float, float], int]]:
    """Velocity (m/s) and number of steps of each leg of the action's own path, without the approach."""
    trajectory: Any = world.plan_trajectory(state, action)
    first = len(trajectory.phases) - len(action.path.phases)
    spans = np.diff(trajectory.times)[first:]
    ways = np.diff(trajectory.poses[:, :2], axis=0)[first:]
    return [
        ((float(way[0] / span), float(way[1] / span)), round(span / step))
        for way, span in zip(ways, spans, strict=True)
        if span > 0.0
    ]


def _loop(built: ShelfSpace, legs: Sequence[tuple[tuple[float, float], int]], dt: float) -> float:
    step, arm = built.space.step, built.arm
    began = time.perf_counter()
    for velocity, count in legs:
        arm.carrier.velocity = arm.body.velocity = velocity
        for _ in range(count):
            step(dt)
    return time.perf_counter() - began
