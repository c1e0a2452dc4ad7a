"""A target that the arm can have grasped at no yaw: said at once, unless the planner may push it or the goal needs no grasp."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import phframe
from phframe.core import (
    Assessment,
    Attempt,
    Cylinder,
    Goal,
    Options,
    Plan,
    Planner,
    Scene,
    State,
    Status,
    Task,
    Unreachable,
)
from phframe.pushing.retrieve import Retrieve, RetrieveOptions
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of

SCENE = scene_of((0.4, 0.3), (0.2, 0.3))


class Asked(Planner[Options]):
    def search(self, task: Task) -> Plan:
        return Plan(Status.FAILED, "asked")


class Pusher(Asked):
    pushes_target = True


class Tidy(Goal[Options]):
    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        return Assessment(Status.FAILED, "untidy")


RETRIEVE = Retrieve(RetrieveOptions())


def plan(planner: Planner[Any], goal: Goal[Any], beyond: set[str]) -> tuple[Plan, list[str]]:
    """The plan where some objects are out of reach, and which objects were asked for."""
    asked: list[str] = []

    def object_reach(state: State, object_id: str) -> Unreachable | None:
        assert state == SCENE.initial_state()
        asked.append(object_id)
        return Unreachable(0.1, "too far", 0) if object_id in beyond else None

    with PlanningWorld(WorldSpec(SCENE)) as world:
        topology, rng = create(Kind.TOPOLOGY, "ripser"), np.random.default_rng(0)
        task = world.task(SCENE.initial_state(), topology, rng, goal=goal, object_reach=object_reach)
        return planner.plan(task), asked


def test_nothing_is_searched_for_a_target_out_of_reach() -> None:
    found, asked = plan(Asked(Options()), RETRIEVE, {"target"})
    assert (found.status, found.reason) == (Status.FAILED, "target is out of reach: too far")
    assert asked == ["target"]
    assert found.cost.motion_planning > 0.0


def test_what_is_within_reach_is_searched_for() -> None:
    found, asked = plan(Asked(Options()), RETRIEVE, {"o0"})
    assert (found.reason, asked) == ("asked", ["target"])


def test_the_object_that_is_asked_for_counts_not_the_scenes_target() -> None:
    found, asked = plan(Asked(Options()), Retrieve(RetrieveOptions(target="o0")), {"o0"})
    assert (found.reason, asked) == ("o0 is out of reach: too far", ["o0"])


def test_a_planner_that_pushes_the_target_may_bring_it_within_reach() -> None:
    assert plan(Pusher(Options()), RETRIEVE, {"target"})[0].reason == "asked"


def test_a_goal_without_a_grasp_needs_no_reach() -> None:
    assert plan(Asked(Options()), Tidy(Options()), {"target"})[0].reason == "asked"


@pytest.mark.parametrize("planner", [Asked(Options()), Pusher(Options())])
def test_a_target_that_the_fingers_cannot_enclose_is_refused_at_once(planner: Planner[Any]) -> None:
    """Whoever plans, and in every engine: the planar arm's gripper opens 0.08 m, and the fingers need 3 mm of room each."""
    for radius, asked in ((0.0369, True), (0.0371, False), (0.12, False)):
        wide = replace(SCENE.objects[SCENE.target_index], shape=Cylinder(radius, 0.12))
        with PlanningWorld(WorldSpec(replace(SCENE, objects=(wide,)))) as world:
            topology, rng = create(Kind.TOPOLOGY, "ripser"), np.random.default_rng(0)
            found = planner.plan(world.task(world.scene.initial_state(), topology, rng, goal=RETRIEVE))
        assert (found.reason == "asked") is asked, found
        assert asked or f"{2.0 * radius:g} m wide, too wide for a gripper that opens 0.08 m" in found.reason
        assert found.cost.simulated_actions == 0


@pytest.mark.parametrize("planner", [Asked(Options()), Pusher(Options())])
def test_a_target_that_the_fingers_pass_over_is_refused_at_once(planner: Planner[Any]) -> None:
    """Whoever plans, and in every engine: the fingers of the planar arm begin 0.04 m above the board."""
    for height, asked in ((0.03, False), (0.0399, False), (0.041, True)):
        low = replace(SCENE.objects[SCENE.target_index], shape=Cylinder(0.03, height))
        objects = tuple(low if item.id == SCENE.target else item for item in SCENE.objects)
        with PlanningWorld(WorldSpec(replace(SCENE, objects=objects))) as world:
            topology, rng = create(Kind.TOPOLOGY, "ripser"), np.random.default_rng(0)
            found = planner.plan(world.task(world.scene.initial_state(), topology, rng, goal=RETRIEVE))
        assert (found.reason == "asked") is asked, found
        assert asked or f"target is {height:g} m tall, and the fingers pass over the board at 0.04 m" in found.reason
        assert found.cost.simulated_actions == 0


@pytest.mark.slow
@pytest.mark.needs_mujoco
@pytest.mark.needs_baxter
@pytest.mark.needs_ompl
@pytest.mark.parametrize("arm", ["auto", "figures"])
def test_baxter_says_it_before_anything_is_simulated_and_is_mounted_as_the_episode_says(arm: str) -> None:
    for library in ("mujoco", "pinocchio", "ompl"):
        pytest.importorskip(library)
    given = {"mount": "auto"} if arm == "auto" else {"side": "left", "mount": [-0.675, -0.058, -0.15, 0.0]}
    episode = phframe.solve("papallas/s05", planner=Asked, backend="mujoco", arm="baxter", options={"arm": given})
    mount = episode.spec.options["arm"]["mount"]
    assert [type(figure) for figure in mount] == [float] * 4
    if arm == "auto":
        assert episode.reason == "asked"
        again = phframe.run(episode.spec)
        assert (again.spec, again.reason) == (episode.spec, "asked"), "nothing is chosen anew"
    else:
        assert mount == [-0.675, -0.058, -0.15, 0.0]
        assert "target is out of reach: arm 'baxter' gets there at no yaw, even in an empty shelf" in episode.reason
        assert episode.plans[0].cost.simulated_actions == 0
        assert episode.steps == ()
