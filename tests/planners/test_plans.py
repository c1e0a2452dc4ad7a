"""Plans are what they say: applied again, bit by bit; the same for the same seed; within their limits."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from phframe.core import Action, Budget, Cylinder, Plan, Rejection, Scene, SceneObject, Shelf, Status
from phframe.pushing import PushDecision
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.runtime.summary import summarize
from phframe.runtime.world import WorldSpec
from tests.planners.solved import PLANNERS, episodes, plan_of
from tests.pushing.parts import scene_of

both = pytest.mark.parametrize("planner", PLANNERS)
TYPICAL = ("vieira/basic", "vieira/example-08", "papallas/s03")


def planned(
    scene: Scene,
    planner: str = "phia",
    *,
    budget: Budget = Budget(),  # noqa: B008 - immutable
    rejected: tuple[Action, ...] = (),
    **options: object,
) -> Plan:
    with PlanningWorld(WorldSpec(scene)) as world:
        task = world.task(
            scene.initial_state(),
            create(Kind.TOPOLOGY, "ripser"),
            np.random.default_rng(0),
            goal=create(Kind.GOAL, "retrieve"),
            budget=budget,
            rejected=tuple(Rejection(action, "it came to nothing") for action in rejected),
        )
        plan: Plan = create(Kind.PLANNER, planner, options).plan(task)
        return plan


@both
def test_expected_states_are_what_the_actions_make_of_them_bit_by_bit(planner: str) -> None:
    compared = 0
    for episode in episodes(planner)[::6]:
        with PlanningWorld(WorldSpec(episode.scene)) as world:
            state = episode.scene.initial_state()
            for action, expected in zip(episode.plans[0].actions, episode.plans[0].expected, strict=True):
                state = world.apply(state, action).state
                assert state == expected
                compared += 1
    assert compared >= 8


@both
def test_what_was_carried_out_is_what_was_expected(planner: str) -> None:
    for episode in episodes(planner):
        for step in episode.steps:
            assert step.expected is not None
            assert step.after.held == step.expected.held or step.plan < episode.replans
            assert step.after.displacement(step.expected).max() <= 0.01 or step.plan < episode.replans


@both
@pytest.mark.parametrize("name", TYPICAL)
def test_the_same_task_gives_the_same_plan(planner: str, name: str) -> None:
    again = planned(find_scene(name), planner)
    assert again == plan_of(planner, name)
    assert again.cost.simulated_actions == plan_of(planner, name).cost.simulated_actions


SOLVE_ALL = """
import json, sys
from phframe.runtime.solve import solve
from phframe.runtime.summary import summarize
scenes = sys.argv[1:]
print(json.dumps([summarize(solve(scene, planner=planner, seed=3)) for planner in ("phia", "ooa") for scene in scenes]))
"""


@pytest.mark.slow
def test_two_processes_come_to_the_same_summaries() -> None:
    environment = {**os.environ, "PYTHONHASHSEED": "12345", "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", SOLVE_ALL, *TYPICAL]
    theirs = json.loads(subprocess.run(command, env=environment, check=True, capture_output=True).stdout)
    ours = [summarize(solve(name, planner=planner, seed=3)) for planner in PLANNERS for name in TYPICAL]
    for one, other in zip(ours, theirs, strict=True):
        assert {**one, "planning_time": 0} == {**other, "planning_time": 0}


@both
@pytest.mark.parametrize("short", [1, 2])
def test_no_more_actions_than_allowed(planner: str, short: int) -> None:
    most = len(plan_of(planner, "vieira/example-03").actions) - 1 - short
    plan = planned(find_scene("vieira/example-03"), planner, max_actions=most)
    assert (plan.status, len(plan.actions)) == (Status.FAILED, most)
    assert plan.reason == f"the corridor is not empty after {most} actions"


def test_the_grasp_is_not_counted_among_them() -> None:
    enough = len(plan_of("phia", "vieira/example-03").actions) - 1
    plan = planned(find_scene("vieira/example-03"), max_actions=enough)
    assert plan.status is Status.RETRIEVED


@both
def test_time_and_simulations_that_run_out_are_a_result(planner: str) -> None:
    late = planned(find_scene("vieira/basic"), planner, budget=Budget(seconds=0.0))
    assert (late.status, late.reason, late.actions) == (Status.TIMEOUT, "the time limit of 0 s is used up", ())
    short = planned(find_scene("vieira/basic"), planner, budget=Budget(simulations=1))
    assert (short.status, short.cost.simulated_actions) == (Status.TIMEOUT, 1)
    assert "1 simulated actions" in short.reason


@both
@pytest.mark.parametrize("name", ["vieira/basic", "vieira/example-08", "vieira/simple-05"])
def test_rejected_actions_are_not_proposed_again(planner: str, name: str) -> None:
    scene, rejected = find_scene(name), tuple(plan_of(planner, name).actions)
    for _ in range(4):
        plan = planned(scene, planner, rejected=rejected)
        assert not [action.name for action in plan.actions if any(map(action.resembles, rejected))]
        rejected = (*rejected, *plan.actions)
    assert len(rejected) > len(plan_of(planner, name).actions)


def wide_target(radius: float) -> Scene:
    objects = (SceneObject("o", Cylinder(0.03), (0.2, 0.3)), SceneObject("target", Cylinder(radius), (0.45, 0.3)))
    return Scene("wide", Shelf(0.6, 0.6), objects, "target")


def walled_in() -> Scene:
    """Obstacles that fill the shelf from wall to wall: none can be moved aside."""
    row = [(0.2, 0.031 + 0.0602 * k) for k in range(5)]
    return scene_of((0.5, 0.16), *row, *[(0.2605, y) for _, y in row], shelf=Shelf(0.6, 0.33))


UNSOLVABLE = {
    "too wide for the gripper": (wide_target(0.045), "too wide for a gripper that opens 0.08 m"),
    "narrower than the corridor": (scene_of((0.4, 0.1), (0.2, 0.1), shelf=Shelf(0.6, 0.2)), "set half_width"),
    "narrower than the arm": (scene_of((0.4, 0.055), shelf=Shelf(0.6, 0.11)), "set half_width"),
}


@both
@pytest.mark.parametrize("case", UNSOLVABLE)
def test_what_cannot_be_solved_is_a_result_that_says_why(planner: str, case: str) -> None:
    scene, reason = UNSOLVABLE[case]
    plan = planned(scene, planner)
    assert plan.status is Status.FAILED
    assert reason in plan.reason
    episode = solve(scene, planner=planner)
    assert (episode.status, episode.reason, episode.steps) == (Status.FAILED, plan.reason, ())


@both
def test_a_shelf_walled_off_is_a_result_after_few_simulations(planner: str) -> None:
    plan = planned(walled_in(), planner, max_actions=8)
    assert plan.status is Status.FAILED
    assert plan.reason
    assert plan.cost.simulated_actions < 100


def test_a_narrow_shelf_can_be_solved_with_an_automatic_half_width() -> None:
    scene = scene_of((0.4, 0.1), shelf=Shelf(0.6, 0.2))
    assert planned(scene).status is Status.FAILED
    plan = planned(scene, half_width="auto")
    assert plan.status is Status.RETRIEVED
    corridor = PushDecision.of(plan.decisions[-1]).corridor
    assert corridor is not None
    assert corridor.half_width == pytest.approx(0.06 + 0.004)


def test_options_matter() -> None:
    scene = find_scene("vieira/basic")
    usual = PushDecision.of(plan_of("phia", "vieira/basic").decisions[0])
    narrow = PushDecision.of(planned(scene, half_width=0.094).decisions[0])
    wide = PushDecision.of(planned(scene, insertion_width=0.06).decisions[0])
    strict = PushDecision.of(planned(scene, margin=0.0).decisions[0])
    assert narrow.corridor is not None
    assert narrow.corridor.half_width == 0.094
    assert len(narrow.members) < len(usual.members)
    assert wide.radius != usual.radius
    assert strict.persistent_radii != usual.persistent_radii
    slow = planned(scene, sweep_speed=0.1, insert_speed=0.1, reach_speed=0.1)
    for action in slow.actions:
        assert {action.path.rule(leg).speed for leg in range(len(action.path.phases))} == {0.1}
