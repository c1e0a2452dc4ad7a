"""The task that every meter plans: retrieve the scene's target, with Ripser and the seed 0."""

from __future__ import annotations

import numpy as np

from phframe.core import Task
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld


def retrieval_task(world: PlanningWorld) -> Task:
    """The task of a world's scene as it is written."""
    topology, goal = create(Kind.TOPOLOGY, "ripser"), create(Kind.GOAL, "retrieve")
    return world.task(world.scene.initial_state(), topology, np.random.default_rng(0), goal=goal)
