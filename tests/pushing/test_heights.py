"""Heights count: what the gripper passes over is no obstacle, and a shelf too low for the arm is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import phframe
from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import GRAZING, Cylinder, Infeasible, Scene, Shelf, Status
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.planners.sure import SureOptions
from phframe.pushing import Grasp, Pushing, StraightPusher, StraightPushOptions
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of
from tests.pushing.worlds import task_in

ARM = PlanarArm(PlanarArmOptions()).shape
LOW = ARM.fingers_bottom - 0.01


def with_height(scene: Scene, row: int, height: float) -> Scene:
    objects = list(scene.objects)
    objects[row] = replace(objects[row], shape=Cylinder(objects[row].radius, height))
    return replace(scene, objects=tuple(objects))


BLOCKED = scene_of((0.35, 0.3), (0.2, 0.3))
OVER = with_height(BLOCKED, 1, LOW)


@pytest.mark.parametrize("above", [-0.01, 0.0, GRAZING / 2.0, 0.001, 0.05])
def test_a_part_meets_what_is_taller_than_it_is_high(above: float) -> None:
    assert any(ARM.meets(ARM.fingers_bottom + above)) == (above > GRAZING)


def test_what_the_arm_passes_over_blocks_neither_corridor_nor_grasp() -> None:
    for scene, blocks in ((BLOCKED, True), (OVER, False)):
        with PlanningWorld(WorldSpec(scene)) as world:
            pushing = Pushing(task_in(world), SureOptions())
            problem = pushing.problem(scene.initial_state())
            assert not isinstance(problem, Infeasible)
            assert (problem.members.tolist() == [1]) == blocks
            assert isinstance(pushing.grasp(problem), Infeasible if blocks else Grasp)


def test_a_target_that_would_push_it_out_is_no_way_between_walls_free_of_objects() -> None:
    with PlanningWorld(WorldSpec(OVER)) as world:
        pushing = Pushing(task_in(world), SureOptions())
        problem = pushing.problem(OVER.initial_state())
        assert not isinstance(problem, Infeasible)
        found = pushing.grasp(problem)
        assert isinstance(found, Grasp)
        assert not found.withdraws_between_walls


def test_it_cannot_be_pushed() -> None:
    with PlanningWorld(WorldSpec(OVER)) as world:
        pusher = StraightPusher(Pushing(task_in(world), SureOptions()), StraightPushOptions())
        assert "passes over it" in pusher.refusal(OVER.initial_state(), 1, np.array([0.2, 0.45]))


@pytest.mark.parametrize("backend", ["pymunk", pytest.param("mujoco", marks=pytest.mark.needs_mujoco)])
@pytest.mark.parametrize("planner", ["phia", "sure"])
def test_nothing_is_pushed_where_only_that_is_in_front_of_the_target(backend: str, planner: str) -> None:
    if backend == "mujoco":
        pytest.importorskip("mujoco")
    episode = phframe.solve(OVER, planner=planner, backend=backend)
    assert episode.status is Status.RETRIEVED
    assert (episode.pushes, episode.replans) == (0, 0)


def test_a_shelf_too_low_for_the_arm_is_refused_at_once() -> None:
    flat = with_height(with_height(BLOCKED, 0, ARM.top), 1, ARM.top)
    low = replace(flat, shelf=Shelf(0.5, 0.6, ARM.top))
    with PlanningWorld(WorldSpec(low)) as world:
        plan = PHIA(PHIAOptions()).plan(task_in(world))
    assert plan.status is Status.FAILED
    assert plan.reason == f"the shelf is {ARM.top:g} m high: the arm, up to {ARM.top:g} m high, does not go in"
    assert plan.cost.simulated_actions == 0
