"""Episodes in which reality is not what was planned: real worlds, with one thing changed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from phframe.core import (
    Action,
    Condition,
    Episode,
    Loop,
    Motion,
    Plan,
    Planner,
    RunSpec,
    Scene,
    State,
    Task,
    Trajectory,
    Unreachable,
    Watch,
)
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.registry import Kind, create
from phframe.runtime.episode import run_episode
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.observer import Observer
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec

BASIC = find_scene("vieira/basic")
Meddle = Callable[[State], State]


class Meddling(ExecutionWorld):
    """Somebody changes the world after some of the actions.

    Args:
        spec: As for every world.
        meddle: What is done, by the number of actions carried out before it.
    """

    def __init__(self, spec: WorldSpec, meddle: dict[int, Meddle]) -> None:
        super().__init__(spec)
        self._meddle, self._done = meddle, 0

    def execute(self, trajectory: Trajectory, watch: Watch | None = None) -> Motion:
        motion = super().execute(trajectory, watch)
        self._done += 1
        if change := self._meddle.get(self._done):
            self.physics.restore(change(self.physics.observe()))
        return motion


class Clumsy(ExecutionWorld):
    """An arm that cannot carry out some of what it is asked to."""

    def __init__(self, spec: WorldSpec, refuses: Callable[[Action], bool]) -> None:
        super().__init__(spec)
        self._refuses = refuses
        self.refused: list[Action] = []

    def plan_trajectory(self, state: State, action: Action) -> Trajectory | Unreachable:
        if self._refuses(action):
            self.refused.append(action)
            return Unreachable(0.1, "joint 4 at its limit")
        return super().plan_trajectory(state, action)


class Noting(PHIA):
    """PHIA, noting the tasks it is given."""

    def __init__(self, options: PHIAOptions = PHIAOptions()) -> None:  # noqa: B008 - immutable
        super().__init__(options)
        self.tasks: list[Task] = []

    def search(self, task: Task) -> Plan:
        self.tasks.append(task)
        return super().search(task)


def shifted(name: str, by: tuple[float, float], scene: Scene = BASIC) -> Meddle:
    """An object is moved."""

    def meddle(state: State) -> State:
        poses = state.poses.copy()
        poses[scene.index(name), :2] += by
        return replace(state, poses=poses)

    return meddle


def spilled(name: str, scene: Scene = BASIC) -> Meddle:
    """An object falls off the board."""

    def meddle(state: State) -> State:
        conditions = list(state.conditions)
        conditions[scene.index(name)] = Condition.SPILLED
        return replace(state, conditions=tuple(conditions))

    return meddle


def toppled(name: str, scene: Scene = BASIC) -> Meddle:
    """An object falls over."""

    def meddle(state: State) -> State:
        conditions = list(state.conditions)
        conditions[scene.index(name)] = Condition.TOPPLED
        return replace(state, conditions=tuple(conditions))

    return meddle


def run(
    execution: ExecutionWorld,
    planner: Planner[Any] | None = None,
    *,
    planning: WorldSpec | None = None,
    loop: Loop = Loop(),  # noqa: B008 - immutable
    observers: Sequence[Observer] = (),
    seed: int = 0,
) -> Episode:
    """An episode, in the execution world's own scene; it is closed afterwards."""
    spec = RunSpec(seed=seed, loop=loop)
    with execution, PlanningWorld(planning or WorldSpec(execution.scene)) as plans_in:
        topology = create(Kind.TOPOLOGY, "ripser")
        goal = create(Kind.GOAL, "retrieve")
        return run_episode(planner or Noting(), topology, plans_in, execution, goal, spec, observers)


def arm_file(folder: Path) -> str:
    """A spec of an arm that is the planar one under another name."""
    path = folder / "other_arm.py"
    path.write_text("from phframe.arms.planar import PlanarArm\n\n\nclass OtherArm(PlanarArm):\n    pass\n")
    return f"{path}:OtherArm"
