"""The engine that executes, asked before it does: built when it is needed, as the planner believes the world to be."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from phframe.core import Plan, RunSpec, Scene, SearchTree, Status, Task, coulomb_with_board
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.runtime import confirmation
from phframe.runtime.confirmation import Confirmation
from phframe.runtime.noise import Noise
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.run import prepare, run
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.pushing.worlds import task_in
from tests.runtime.worlds import BASIC

ELSEWHERE = {"object_friction": 0.35, "arm_friction": 0.45}


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[PlanningWorld]]:
    """The worlds that are built for confirmation; they are real."""
    worlds: list[PlanningWorld] = []

    class Noted(PlanningWorld):
        def __init__(self, spec: WorldSpec, workers: int = 1) -> None:
            super().__init__(spec, workers)
            worlds.append(self)
            self.closed = False

        def close(self) -> None:
            super().close()
            self.closed = True

    monkeypatch.setattr(confirmation, "PlanningWorld", Noted)
    yield worlds
    assert all(getattr(world, "closed", False) for world in worlds), "what was built is closed"


def first_action() -> Any:
    with PlanningWorld(WorldSpec(BASIC)) as world:
        return PHIA(PHIAOptions()).plan(task_in(world)).actions[0]


def test_it_is_built_once_and_only_when_it_is_asked(built: list[PlanningWorld]) -> None:
    spec, action = WorldSpec(BASIC, backend_options=ELSEWHERE), first_action()
    with Confirmation(spec):
        pass
    assert not built
    with Confirmation(spec) as asked, PlanningWorld(spec) as alike:
        assert asked.motion_planning_time == 0.0
        start = BASIC.initial_state()
        assert asked.apply(start, action) == alike.apply(start, action)
        assert asked.apply(start, action) == asked.apply(start, action)
    assert len(built) == 1
    assert built[0].spec == spec


class Asking(PHIA):
    """Plans nothing, but notes what it is given."""

    def __init__(self) -> None:
        super().__init__(PHIAOptions())
        self.task: Task | None = None
        self.confirmed: list[float] = []

    def search(self, task: Task) -> Plan:
        self.task = task
        plan = super().search(task)
        if task.confirms:
            apart = task.apply(task.start, plan.actions[0]).state.displacement(
                task.confirm(task.start, plan.actions[0]).state
            )
            self.confirmed.append(float(apart.max()))
        return SearchTree(task.start).plan(0, Status.FAILED, "it only asks")


def asked(**spec: Any) -> Asking:
    planner = Asking()
    run(RunSpec(scene=spec.pop("scene", "vieira/basic"), planner=planner, **spec))
    return planner


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"noise": {"position": 0.005, "friction": 0.3}},
        {"plan_backend": "pymunk", "plan_arm": "planar"},
        {"options": {"backend": ELSEWHERE}},
        {"options": {"backend": ELSEWHERE, "plan_backend": ELSEWHERE}},
    ],
    ids=["nothing said", "noise", "the same named", "options inherited", "the same options"],
)
def test_where_the_engines_are_the_same_there_is_none(more: dict[str, Any], built: list[PlanningWorld]) -> None:
    planner = asked(**more)
    assert planner.task is not None
    assert not planner.task.confirms
    assert not built


def test_where_they_differ_it_is_the_one_that_executes(built: list[PlanningWorld]) -> None:
    planner = asked(options={"backend": ELSEWHERE, "plan_backend": {"object_friction": 0.1, "arm_friction": 0.1}})
    assert planner.task is not None
    assert planner.task.confirms
    [distance] = planner.confirmed
    assert distance > 1e-5
    assert dict(built[0].spec.backend_options) == ELSEWHERE


def test_planners_that_do_not_ask_cost_nothing(built: list[PlanningWorld]) -> None:
    episode = solve("vieira/basic", planner="phia", options={"plan_backend": ELSEWHERE})
    assert episode.steps
    assert not built


def frictions(scene: Scene) -> list[float]:
    return [coulomb_with_board(scene, item) for item in scene.objects]


def test_it_is_as_the_planner_believes_the_world_to_be(built: list[PlanningWorld]) -> None:
    """What noise hides is not in it."""
    noise = {"position": 0.005, "friction": 0.3}
    asked(noise=noise, options={"plan_backend": ELSEWHERE}, seed=3)
    [world] = built
    scene = find_scene("vieira/basic")
    believed = Noise.of(noise).believed(scene, 3)
    assert frictions(world.scene) == frictions(believed)
    assert not np.isclose(frictions(world.scene), frictions(scene)).any()
    ready = prepare(RunSpec(scene="vieira/basic", noise=noise, options={"plan_backend": ELSEWHERE}, seed=3))
    assert world.scene == ready.plan_world.scene
    assert world.spec.backend_options == ready.world.backend_options
