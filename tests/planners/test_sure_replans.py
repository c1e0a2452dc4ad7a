"""Sure again: a replan knows what the plan before it had tried, and what was rejected stays so; budgets decide alone."""

from __future__ import annotations

from dataclasses import replace

import pytest

from phframe.core import (
    ROOT,
    Action,
    Budget,
    ExploredTree,
    Plan,
    Status,
    Task,
)
from phframe.planners.sure import Sure, SureOptions
from phframe.pushing import Deviation, PushDecision
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from tests.planners.solved import episodes
from tests.planners.sure_plans import HARD, ONE, SOME, planned, pushes_of, tree_of
from tests.pushing.parts import rejections
from tests.pushing.worlds import task_in
from tests.runtime.worlds import Meddling, run, shifted

# --- Again ---


def test_a_plan_from_where_the_last_one_was_to_be_simulates_less() -> None:
    scene = next(each.scene for each in episodes("sure") if each.pushes >= 2)
    with PlanningWorld(WorldSpec(scene)) as world:
        first = Sure(SureOptions()).plan(task_in(world))
        for done in (0, 1):
            start = first.expected[done - 1] if done else scene.initial_state()
            again, anew = (
                Sure(SureOptions()).plan(task_in(world, start, earlier=earlier))
                for earlier in (tree_of(first).after(done), None)
            )
            assert again.actions == first.actions[done:]
            assert again.cost.simulated_actions < anew.cost.simulated_actions
            assert again.cost.simulated_actions < first.cost.simulated_actions


class Noting(Sure):
    """Notes what it is told of the plan before."""

    def __init__(self) -> None:
        super().__init__(SureOptions())
        self.earlier: list[ExploredTree | None] = []

    def search(self, task: Task) -> Plan:
        self.earlier.append(task.earlier)
        return super().search(task)


def test_in_an_episode_a_replan_knows_what_the_plan_before_had_tried() -> None:
    scene = next(each.scene for each in episodes("sure") if each.pushes >= 2)
    planner, target = Noting(), scene.target
    episode = run(Meddling(WorldSpec(scene), {1: shifted(target, (0.0, 0.012), scene)}), planner)
    assert episode.status is Status.RETRIEVED
    assert len(episode.plans) >= 2
    first, (none, earlier, *_) = episode.plans[0], planner.earlier
    assert none is None
    assert earlier is not None
    assert earlier.nodes[ROOT].state == first.expected[0]
    assert [node.action for node in earlier.path] == list(first.actions[1:])


def test_where_the_world_is_another_what_was_to_come_next_is_tried_first() -> None:
    scene = next(each.scene for each in episodes("sure") if each.pushes >= 2)
    first = planned(scene)
    far = scene.ids.index(max(scene.ids))
    moved = first.expected[0].poses.copy()
    moved[far, 1] += 1e-4
    start = replace(first.expected[0].parked(), poses=moved)
    again = planned(scene, start=start, earlier=tree_of(first).after(1))
    tried = pushes_of(again)[0].action
    assert tried is not None
    assert tried.path == first.actions[1].path


def test_what_was_rejected_is_not_proposed_again() -> None:
    for scene in (ONE, SOME[0]):
        rejected: list[Action] = []
        for _ in range(3):
            plan = planned(scene, {"max_nodes": 40}, rejected=rejections(rejected))
            tried = [node.action for node in tree_of(plan).nodes[1:] if node.action]
            assert not any(each.resembles(action) for each in rejected for action in tried)
            rejected.extend(plan.actions[:1])
        assert len(rejected) == 3


def test_not_even_cut_short() -> None:
    """A push that stalls is cut short anew each time; what was rejected of that is left alone."""

    def cut(plan: Plan) -> list[Action]:
        found = [(node.action, PushDecision.of(node.decision).deviations) for node in tree_of(plan).nodes[1:]]
        return [action for action, deviations in found if action and Deviation.CUT_SHORT in deviations]

    scene = find_scene("papallas/s01")
    options = {"max_nodes": 40, "grasp": "empty-corridor", "target_pushes": False}
    for name in (scene.name, "random/0", "random/5", HARD):
        scene = find_scene(name)
        before = cut(planned(scene, options))
        if before:
            after = cut(planned(scene, options, rejected=rejections(before)))
            assert not any(each.resembles(action) for each in before for action in after)
            return
    pytest.fail("nothing was cut short")


def test_a_budget_of_simulations_decides_alone() -> None:
    scene = find_scene("vieira/basic")
    free = planned(scene)
    assert free.cost.simulated_actions >= 2
    for limit in range(free.cost.simulated_actions + 1):
        slow, quick = (planned(scene, budget=Budget(seconds=seconds, simulations=limit)) for seconds in (1e4, 300.0))
        assert slow == quick
        assert slow.status is (Status.RETRIEVED if limit == free.cost.simulated_actions else Status.TIMEOUT)
        assert slow.cost.simulated_actions == limit
