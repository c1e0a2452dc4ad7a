"""The planner on published scenes, with the real physics and arm."""

from __future__ import annotations

from importlib import metadata
from typing import Any

import numpy as np
import pytest

from phframe.core import Action, Budget, Plan, Scene, State, Status, Task, Transition, time_path
from phframe.registry import Kind, create, discover, load
from phframe_random_push import phframe_extensions
from phframe_random_push.random_push import RandomPush


def scene_named(name: str) -> Scene:
    scene: Scene = create(Kind.SCENES, "vieira").load(name)
    return scene


def task_of(scene: Scene, seed: int, **more: Any) -> Task:
    """A planning problem in pymunk with the planar arm."""
    arm = create(Kind.ARM, "planar")
    backend = load(Kind.BACKEND, "pymunk")
    physics = backend(scene, arm, arm.default_mount(scene.shelf), backend.options_type())

    def apply(state: State, action: Action) -> Transition:
        opening = action.path.rules[action.path.phases[0]].opening
        made: Transition = physics.simulate(state.parked(), time_path(action.path, opening, arm.force_limit))
        return Transition(made.state.parked(), made.motion)

    return Task(
        scene=scene,
        start=scene.initial_state(),
        arm=arm.shape,
        topology=create(Kind.TOPOLOGY, "ripser"),
        apply=apply,
        rng=np.random.default_rng(seed),
        **more,
    )


def plan_for(task: Task, **options: Any) -> Plan:
    return RandomPush(RandomPush.options_type(**options)).plan(task)


@pytest.mark.parametrize("seed", range(3))
def test_it_frees_the_target_of_an_easy_scene(seed: int) -> None:
    scene = scene_named("simple-03")
    plan = plan_for(task_of(scene, seed))
    assert plan.status is Status.RETRIEVED, plan.reason
    assert plan.expected[-1].held == scene.target
    assert len(plan.actions) == len(plan.expected) == len(plan.decisions) > 1


def test_the_same_seed_gives_the_same_plan_and_others_do_not() -> None:
    scene = scene_named("basic")
    plans = [plan_for(task_of(scene, seed)) for seed in (4, 4, 5)]
    assert plans[0] == plans[1]
    assert plans[0].actions != plans[2].actions


def test_every_push_means_one_obstacle_of_the_corridor() -> None:
    plan = plan_for(task_of(scene_named("basic"), 1))
    pushes = [pair for pair in zip(plan.actions, plan.decisions, strict=True) if not pair[0].grasps]
    assert pushes
    for action, decision in pushes:
        assert action.moves == decision.chosen
        assert len(action.moves) == 1
        assert set(action.moves) <= set(decision.members)


def test_both_directions_occur() -> None:
    scene = scene_named("basic")
    sweeps = [decision.sweep for seed in range(4) for decision in plan_for(task_of(scene, seed)).decisions]
    assert {sweep.direction for sweep in sweeps if sweep is not None} == {1, -1}


def test_it_gives_up_after_its_number_of_attempts() -> None:
    plan = plan_for(task_of(scene_named("basic"), 0), max_actions=1)
    assert (plan.status, plan.reason) == (Status.FAILED, "the target is not free after 1 attempts")
    assert plan.cost.simulated_actions == 1


def test_a_spent_budget_is_a_result() -> None:
    plan = plan_for(task_of(scene_named("basic"), 0, budget=Budget(simulations=1)))
    assert plan.status is Status.TIMEOUT


def test_a_rejected_action_is_not_proposed_again() -> None:
    scene = scene_named("basic")
    first = plan_for(task_of(scene, 2)).actions[0]
    assert plan_for(task_of(scene, 2, rejected=(first,))).actions[0] != first


def test_it_is_found_by_its_entry_point() -> None:
    points = [point for point in metadata.entry_points(group="phframe") if point.name == "random-push"]
    if not points:
        pytest.skip("phframe-random-push is importable here, but not installed")
    entry = discover(points).find(Kind.PLANNER, "random-push")
    assert (entry.distribution, entry.extension) == ("phframe-random-push", phframe_extensions()[0])
    assert load(Kind.PLANNER, "random-push", discover(points)) is RandomPush
