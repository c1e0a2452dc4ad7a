"""Tasks for the checks of planners, in a real planning world."""

from __future__ import annotations

from weakref import finalize

import numpy as np

from phframe.core import Action, Budget, Rejection, Scene, State, Task
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from phframe.testing.subjects import MakeTask


def simulated_tasks(backend: str = "pymunk", arm: str = "planar", topology: str = "ripser") -> MakeTask:
    """What makes tasks whose actions are simulated.

    Args:
        backend: Registered name of the physics backend.
        arm: Registered name of the arm.
        topology: Registered name of the topology engine.
    """
    engine, goal = create(Kind.TOPOLOGY, topology), create(Kind.GOAL, "retrieve")

    def make_task(
        scene: Scene,
        *,
        seed: int = 0,
        start: State | None = None,
        budget: Budget = Budget(seconds=60.0),  # noqa: B008 - immutable
        rejected: tuple[Action, ...] = (),
    ) -> Task:
        world, rng = PlanningWorld(WorldSpec(scene, backend, arm)), np.random.default_rng(seed)
        refused = tuple(Rejection(action, "the arm cannot do it") for action in rejected)
        begin = start or scene.initial_state()
        task = world.task(begin, engine, rng, goal=goal, budget=budget, rejected=refused)
        finalize(task, world.close)
        return task

    return make_task
