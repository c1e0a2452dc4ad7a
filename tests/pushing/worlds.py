"""Tasks in the plane, and the drives and pushes that a search meets at their start."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.core import Scene, State, Task
from phframe.planners.sure import SureOptions
from phframe.pushing import Drive, Proposal, Pushing, PushSearch, closest_groups, drives
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import RETRIEVE


def task_in(world: PlanningWorld, start: State | None = None, **more: Any) -> Task:
    """To retrieve the target in a world, from its scene's initial state unless another is given."""
    rng, topology = np.random.default_rng(0), create(Kind.TOPOLOGY, "ripser")
    begin = world.scene.initial_state() if start is None else start
    return world.task(begin, topology, rng, **{"goal": RETRIEVE, **more})


@dataclass(frozen=True)
class Bench:
    """A task in pymunk, and the geometry of it."""

    task: Task
    search: PushSearch

    @property
    def pushing(self) -> Pushing:
        return self.search.pushing

    def drives(self, *fan: float) -> list[Drive]:
        found = drives(self.pushing, self.task.start, fan)
        assert isinstance(found, list)
        return found

    def pushes(self, *fan: float) -> Iterator[Proposal]:
        """Every sweep of every group that blocks any of the drives."""
        for drive in self.drives(*fan):
            if drive.blocking:
                for group in closest_groups(self.pushing, drive.problem, "homology", "all"):
                    yield from self.pushing.sweeps(drive.problem, group.chosen)


@contextmanager
def bench(scene: Scene, **options: Any) -> Iterator[Bench]:
    """A task in pymunk with the geometry of ``sure``."""
    with PlanningWorld(WorldSpec(scene)) as world:
        task = task_in(world)
        yield Bench(task, PushSearch(task, SureOptions.parse(options, "sure")))
