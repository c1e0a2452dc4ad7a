"""Random push: chance decides what is pushed and which way, and nothing else."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from phframe.core import Action, ActionKind, Plan, Scene, Status
from phframe.planners.random_push import RandomPush
from phframe.pushing import PushDecision, Sweep
from phframe.registry import Kind, create
from phframe.runtime.solve import solve
from phframe.testing import simulated_tasks

make_task = simulated_tasks()


def scene_named(name: str) -> Scene:
    scene: Scene = create(Kind.SCENES, "vieira").load(name)
    return scene


def plan_for(scene: Scene, seed: int, **options: Any) -> Plan:
    return RandomPush(RandomPush.options_type(**options)).plan(make_task(scene, seed=seed))


def pushes(plan: Plan) -> list[tuple[Action, PushDecision]]:
    made = zip(plan.actions, plan.decisions, strict=True)
    return [(action, PushDecision.of(why)) for action, why in made if action.kind is ActionKind.PUSH]


@pytest.mark.parametrize("seed", range(3))
def test_it_frees_the_target_of_an_easy_scene(seed: int) -> None:
    scene = scene_named("simple-03")
    plan = plan_for(scene, seed)
    assert plan.status is Status.RETRIEVED, plan.reason
    assert plan.expected[-1].held == scene.target
    assert pushes(plan)


def test_an_episode_is_run_with_it_by_name() -> None:
    episode = solve("vieira/simple-03", planner="random-push", seed=1)
    assert episode.spec.planner == "random-push"
    assert episode.status is Status.RETRIEVED, episode.reason


def test_another_seed_gives_another_plan() -> None:
    first, second = (plan_for(scene_named("basic"), seed) for seed in (4, 5))
    assert first.actions != second.actions


def test_every_push_means_one_obstacle_of_the_corridor() -> None:
    made = pushes(plan_for(scene_named("basic"), 1))
    assert made
    for action, decision in made:
        assert action.moves == decision.chosen
        assert len(action.moves) == 1
        assert set(action.moves) <= set(decision.members)
        assert "other direction" not in decision.deviations, "a random direction deviates from nothing"


def test_both_directions_and_every_obstacle_have_a_chance() -> None:
    scene = scene_named("basic")
    first = [pushes(plan_for(scene, seed, max_actions=1))[0] for seed in range(24)]
    sweeps = [decision.sweep for _, decision in first if isinstance(decision.sweep, Sweep)]
    assert {sweep.direction for sweep in sweeps} == {1, -1}
    assert len({action.moves for action, _ in first}) >= 5  # of the 7 in the corridor


def test_it_gives_up_after_its_number_of_attempts() -> None:
    plan = plan_for(scene_named("basic"), 0, max_actions=1)
    assert (plan.status, plan.reason) == (Status.FAILED, "the target is not free; attempts made: 1")
    assert plan.cost.simulated_actions == 1


def test_sweeps_that_move_nothing_are_left_out_of_the_plan_and_kept_in_the_tree() -> None:
    for seed in range(4):
        scene = scene_named("basic")
        plan = plan_for(scene, seed)
        states = [scene.initial_state(), *plan.expected]
        moved = [np.max(after.displacement(before)) for before, after in pairwise(states)]
        assert min(moved) > 1e-3
        assert plan.tree is not None
        assert len(plan.tree.nodes) - 1 == plan.cost.simulated_actions
