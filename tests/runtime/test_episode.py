"""The closed loop: carry out, observe, replan where reality differs, and know when to stop."""

from __future__ import annotations

import numpy as np
import pytest

from phframe.core import ActionKind, Condition, Episode, Loop, Phase, Plan, RunSpec, Status, Task
from phframe.registry import Kind, create
from phframe.runtime.episode import run_episode
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.runtime.worlds import BASIC, Clumsy, Meddling, Noting, run, shifted, spilled, toppled

SPEC = WorldSpec(BASIC)
USUAL = run(ExecutionWorld(SPEC))
"""Nobody meddles."""


def test_where_the_world_does_as_planned_the_plan_is_carried_out_to_the_letter() -> None:
    assert (USUAL.status, USUAL.reason, USUAL.replans) == (Status.RETRIEVED, "", 0)
    (plan,) = USUAL.plans
    assert [step.action.name for step in USUAL.steps] == [action.name for action in plan.actions]
    for number, step in enumerate(USUAL.steps):
        assert (step.expected, step.decision, step.plan) == (plan.expected[number], plan.decisions[number], 0)


def test_each_step_begins_where_the_last_one_ended() -> None:
    assert USUAL.steps[0].before.poses.tobytes() == BASIC.initial_state().poses.tobytes()
    for earlier, later in zip(USUAL.steps[:-1], USUAL.steps[1:], strict=True):
        assert later.before == earlier.after
    assert USUAL.final_state == USUAL.steps[-1].after


def test_what_is_driven_is_the_path_with_the_way_to_its_beginning() -> None:
    for step in USUAL.steps:
        phases = step.trajectory.phases  # type: ignore[union-attr]
        assert phases == (Phase.APPROACH, *step.action.path.phases)
        assert step.motion.duration >= step.trajectory.duration - 1 / 240.0


def first_target_of(episode: Episode) -> str:
    """An object that the first push did not mean to move."""
    pushed = episode.steps[0].action.moves
    return next(name for name in BASIC.ids if name not in pushed and name != BASIC.target)


def test_an_object_that_is_not_where_it_was_expected_calls_for_a_replan() -> None:
    planner, name = Noting(), first_target_of(USUAL)
    episode = run(Meddling(SPEC, {1: shifted(name, (0.0, 0.011))}), planner)
    assert episode.replans == 1
    assert [step.plan for step in episode.steps[:2]] == [0, 1]
    assert planner.tasks[1].start == episode.steps[0].after == episode.steps[1].before
    assert planner.tasks[1].rejected == (), "something moved: the action is not to blame"
    moved = episode.steps[0].after.displacement(episode.plans[0].expected[0])
    assert moved[BASIC.index(name)] == pytest.approx(0.011, abs=2e-3)
    assert episode.status is Status.RETRIEVED


def test_less_than_the_tolerance_does_not() -> None:
    name = first_target_of(USUAL)
    assert run(Meddling(SPEC, {1: shifted(name, (0.0, 0.004))})).replans == 0
    assert run(Meddling(SPEC, {1: shifted(name, (0.0, 0.004))}), loop=Loop(tolerance=0.002)).replans >= 1


def test_an_object_that_was_lost_calls_for_a_replan_too() -> None:
    name = first_target_of(USUAL)
    episode = run(Meddling(SPEC, {1: spilled(name)}))
    assert episode.replans >= 1
    assert episode.spilled == (name,)
    assert (episode.status, episode.clean) == (Status.RETRIEVED, False)


def test_where_something_lies_that_had_toppled_before_is_no_reason_to_replan() -> None:
    name = first_target_of(USUAL)
    once = run(Meddling(SPEC, {1: toppled(name)}))
    again = run(Meddling(SPEC, {1: toppled(name), 2: shifted(name, (0.0, 0.02))}))
    assert once.replans >= 1
    assert again.replans == once.replans


def test_a_target_that_is_lost_ends_it() -> None:
    episode = run(Meddling(SPEC, {1: spilled(BASIC.target)}))
    assert episode.status is Status.FAILED
    assert episode.reason.endswith(f"the target {BASIC.target!r} is spilled")
    assert (len(episode.steps), len(episode.plans)) == (1, 1)
    assert episode.final_state.conditions[BASIC.target_index] is Condition.SPILLED


@pytest.mark.parametrize("most", [0, 1, 3])
def test_the_planner_is_asked_again_so_often_and_no_more(most: int) -> None:
    """Something is always put out of place."""
    name = first_target_of(USUAL)
    always = {number: shifted(name, (0.0, 0.02 * (-1) ** number)) for number in range(1, 99)}
    episode = run(Meddling(SPEC, always), loop=Loop(max_replans=most))
    if episode.status is not Status.RETRIEVED:
        assert (episode.status, episode.replans) == (Status.FAILED, most)
        assert name in episode.reason
        assert "0.020 m from where it was expected" in episode.reason
    assert episode.replans <= most
    if most == 0:
        assert (episode.status, len(episode.steps)) == (Status.FAILED, 1)


def test_other_friction_in_the_real_world_is_dealt_with() -> None:
    rough = WorldSpec(BASIC, backend_options={"object_friction": 1.0, "arm_friction": 1.2})
    episode = run(ExecutionWorld(rough), planning=SPEC, loop=Loop(tolerance=0.002))
    assert episode.replans >= 1
    assert episode.status is Status.RETRIEVED
    for step in episode.steps:
        assert step.before in {episode.steps[0].before, *(each.after for each in episode.steps)}


def test_a_failed_plan_is_not_carried_out() -> None:
    episode = solve("vieira/basic", options={"planner": {"max_actions": 1}})
    assert (episode.status, episode.steps) == (Status.FAILED, ())
    assert len(episode.plans[0].actions) == 1
    assert episode.reason == episode.plans[0].reason
    assert episode.final_state == BASIC.initial_state()
    assert (episode.pushes, episode.execution_time, episode.target_moved) == (0, 0.0, 0.0)


def test_an_action_that_the_arm_cannot_do_is_not_carried_out_and_not_proposed_again() -> None:
    first = USUAL.plans[0].actions[0]
    world, planner = Clumsy(SPEC, lambda action: action == first), Noting()
    episode = run(world, planner)
    assert world.refused == [first]
    assert episode.replans == 1
    assert [each.action for each in planner.tasks[1].rejected] == [first]
    assert [(each.reason, each.plan) for each in episode.rejections] == [
        (f"the arm cannot do {first.name}: joint 4 at its limit", 0)
    ]
    assert first not in episode.plans[1].actions
    assert first not in [step.action for step in episode.steps]
    assert episode.status is Status.RETRIEVED


def test_an_arm_that_can_do_nothing_fails_and_says_why() -> None:
    world = Clumsy(SPEC, lambda action: True)
    episode = run(world, loop=Loop(max_replans=3))
    assert (episode.status, episode.steps) == (Status.FAILED, ())
    assert len(world.refused) == len({action.path for action in world.refused})
    assert "joint 4 at its limit" in episode.reason
    assert len(episode.rejections) == len(world.refused)


def test_a_grasp_that_the_arm_cannot_do_leaves_the_corridor_cleared() -> None:
    world = Clumsy(SPEC, lambda action: action.kind is ActionKind.GRASP)
    episode = run(world, loop=Loop(max_replans=2))
    assert episode.status in (Status.CLEARED, Status.FAILED)
    assert len(episode.plans) <= 3, "what the arm cannot do is a replan like any other"
    assert episode.pushes == USUAL.pushes
    assert len(world.refused) == len({action.path for action in world.refused}), "no grasp is asked for twice"


def test_the_grasp_is_aimed_at_where_the_target_is() -> None:
    pushes = USUAL.pushes
    episode = run(Meddling(SPEC, {pushes: shifted(BASIC.target, (-0.004, 0.003))}))
    assert (episode.status, episode.replans) == (Status.RETRIEVED, 0)
    planned, done = episode.plans[0].actions[-1], episode.steps[-1].action
    row = BASIC.target_index
    off = episode.steps[-1].before.positions[row] - episode.plans[0].expected[-2].positions[row]
    assert off == pytest.approx([-0.004, 0.003], abs=1e-3)
    np.testing.assert_allclose(done.path.poses - planned.path.poses, np.tile([*off, 0.0], (4, 1)), atol=1e-12)
    assert (done.name, done.path.phases) == (planned.name, planned.path.phases)


def test_the_time_limit_is_for_all_planning_together() -> None:
    planner, name = Noting(), first_target_of(USUAL)
    run(Meddling(SPEC, {1: shifted(name, (0.0, 0.02))}), planner, loop=Loop(time_limit=60.0))
    assert planner.tasks[0].budget.seconds == 60.0
    assert 0.0 < planner.tasks[1].budget.seconds <= 60.0 - planner.tasks[0].cost.simulation
    timeout = solve("vieira/basic", time_limit=0.0)
    assert (timeout.status, timeout.steps, len(timeout.plans)) == (Status.TIMEOUT, (), 1)


def test_the_limit_on_simulations_is_for_all_planning_together() -> None:
    planner, name = Noting(), first_target_of(USUAL)
    run(Meddling(SPEC, {1: shifted(name, (0.0, 0.02))}), planner, loop=Loop(simulations=50))
    first, second = planner.tasks
    assert first.budget.simulations == 50
    assert second.budget.simulations == 50 - first.cost.simulated_actions
    enough = first.cost.simulated_actions
    planner = Noting()
    short = run(Meddling(SPEC, {1: shifted(name, (0.0, 0.02))}), planner, loop=Loop(simulations=enough))
    assert (short.status, short.replans, len(short.steps)) == (Status.TIMEOUT, 1, 1)
    assert [task.budget.simulations for task in planner.tasks] == [enough, 0]


def test_a_replan_knows_what_the_last_plan_had_tried_from_where_that_had_got_to() -> None:
    planner, name = Noting(), first_target_of(USUAL)
    meddle = {number: shifted(name, (0.0, 0.011 * (-1) ** number)) for number in (1, 3)}
    episode = run(Meddling(SPEC, meddle), planner)
    carried_out = [sum(step.plan == number for step in episode.steps) for number in range(len(episode.plans))]
    assert carried_out[:2] == [1, 2]
    assert episode.replans >= 2
    earlier = [plan.tree.after(count) for plan, count in zip(episode.plans, carried_out, strict=True) if plan.tree]
    assert [task.earlier for task in planner.tasks] == [None, *earlier[:-1]]


def test_motion_planning_counts_in_the_plan_it_was_for_and_in_the_episode() -> None:
    class Slow(Noting):
        def search(self, task: Task) -> Plan:
            plan = super().search(task)
            world.motion_planning_time += 1000.0
            return plan

    name, goal = first_target_of(USUAL), create(Kind.GOAL, "retrieve")
    with Meddling(SPEC, {1: shifted(name, (0.0, 0.02))}) as execution, PlanningWorld(SPEC) as world:
        world.motion_planning_time, execution.motion_planning_time = 8000.0, 16000.0
        episode = run_episode(Slow(), create(Kind.TOPOLOGY, "ripser"), world, execution, goal, RunSpec())
    assert [round(plan.cost.motion_planning / 1000.0) for plan in episode.plans] == [1, 1]
    assert episode.motion_planning_time == 16000.0 + 8000.0 + 2 * 1000.0


def test_every_replan_has_chance_of_its_own_and_the_same_for_the_same_seed() -> None:
    draws = []
    for seed in (5, 5, 6):
        planner = Noting()
        run(Meddling(SPEC, {1: shifted(first_target_of(USUAL), (0.0, 0.02))}), planner, seed=seed)
        draws.append([task.rng.random() for task in planner.tasks])
    assert draws[0] == draws[1] != draws[2]
    assert len(set(draws[0])) == len(draws[0]) == 2


def test_the_reality_of_an_episode_is_repeatable() -> None:
    again = run(ExecutionWorld(SPEC))
    assert again == USUAL


def test_what_was_planned_for_one_scene_is_solved_in_angled_corridors_too() -> None:
    scene = find_scene("vieira/example-08")
    episode = run(ExecutionWorld(WorldSpec(scene)))
    assert episode.status is Status.RETRIEVED
