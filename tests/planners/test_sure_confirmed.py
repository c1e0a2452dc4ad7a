"""What sure confirms is what then happens; what does not come true, or is beyond the arm, is a dead end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phframe.core import (
    Action,
    ActionKind,
    Episode,
    Motion,
    Plan,
    Scene,
    State,
    Status,
    Stop,
    StopCause,
    StopReason,
    Transition,
    Unreachable,
)
from phframe.core.particle import Apply
from phframe.planners.sure import Sure, SureOptions
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.planners.sure_plans import (
    CONFIRMED,
    ELSEWHERE,
    HARD,
    ONE,
    SOME,
    Counted,
    assert_told,
    kinds,
    planned,
    topples_first,
    tree_of,
)
from tests.pushing.parts import scene_of
from tests.pushing.worlds import task_in

# --- What the arm reaches ---


class Reaching:
    """An arm that can grasp at some angles only.

    Args:
        can: Whether it can, by the gripper's yaw.
    """

    def __init__(self, can: Callable[[float], bool]) -> None:
        self._can = can
        self.asked = 0

    def __call__(self, state: State, action: Action) -> Unreachable | None:
        self.asked += 1
        yaw = float(action.path.poses[0, 2])
        return None if self._can(yaw) else Unreachable(0.1, f"joint 4 at its limit, yaw {np.degrees(yaw):.0f}")


@pytest.mark.parametrize("scene", [scene_of((0.45, 0.3)), ONE, SOME[0]], ids=["alone", "blocked", "basic"])
def test_a_target_beyond_the_arm_is_given_up_after_two_dozen_questions(scene: Scene) -> None:
    reach = Reaching(lambda yaw: False)
    plan = planned(scene, reach=reach)
    assert plan.status is Status.FAILED
    assert "the arm cannot grasp the target at any angle, even in an empty shelf: joint 4 at its limit" in plan.reason
    assert 1 <= reach.asked <= 26


def test_the_same_where_the_arm_that_plans_is_the_one_that_executes() -> None:
    """Then simulating a grasp tells that it is beyond the arm."""

    def apply(state: State, action: Action, stop: Stop | None = None) -> Transition:
        if action.kind is ActionKind.GRASP:
            why = StopReason(StopCause.UNREACHABLE, unreachable=Unreachable(0.1, "joint 4 at its limit"))
            return Transition(state, Motion(0.0, stopped=why))
        return world.apply(state, action, stop)

    reach = Reaching(lambda yaw: False)
    with PlanningWorld(WorldSpec(ONE)) as world:
        task = task_in(world, reach=reach)
        task._apply = apply
        plan = Sure(SureOptions()).plan(task)
    assert plan.status is Status.FAILED
    assert "the arm cannot grasp the target at any angle" in plan.reason
    assert plan.cost.simulated_actions <= 12
    assert reach.asked <= 26


@pytest.mark.parametrize("side", [1, -1])
def test_an_arm_that_reaches_some_angles_grasps_at_one_of_them(side: int) -> None:
    reach = Reaching(lambda yaw: side * yaw > np.radians(20.0))
    for scene in (scene_of((0.4, 0.3)), ONE):
        plan = planned(scene, reach=reach)
        assert plan.status is Status.RETRIEVED
        assert side * plan.actions[-1].path.poses[0, 2] > np.radians(20.0)


def test_an_arm_that_reaches_less_deep_grasps_less_deep() -> None:
    """Without pushing what is not in its way."""

    def reach(_: State, action: Action) -> Unreachable | None:
        return Unreachable(0.1, "too far") if action.path.poses[1, 0] > 0.458 else None

    plan = planned(scene_of((0.45, 0.3)), reach=reach)
    assert plan.status is Status.RETRIEVED
    assert len(plan.actions) == 1


# --- What is confirmed ---


def confirmed_in(scene: Scene, confirm: Apply, **options: Any) -> Plan:
    return planned(scene, options, confirm=confirm)


def test_what_does_not_come_true_is_a_dead_end_and_something_else_is_found() -> None:
    first = planned(ONE)
    assert kinds(first) == [ActionKind.PUSH, ActionKind.GRASP]

    def confirm(state: State, action: Action, stop: Stop | None = None) -> Transition:
        made = other.apply(state, action, stop)
        return topples_first(made, action) if action.resembles(first.actions[0]) else made

    with PlanningWorld(WorldSpec(ONE)) as other:
        plan = confirmed_in(ONE, confirm)
    assert plan.status is Status.RETRIEVED
    assert not any(action.resembles(first.actions[0]) for action in plan.actions)
    closed = [node for node in tree_of(plan).nodes if node.closed.startswith("when confirmed: ")]
    assert [node.closed for node in closed] == ["when confirmed: o0 is toppled"]
    assert_told(ONE, plan)


def test_where_nothing_comes_true_it_says_so() -> None:
    def stalls(state: State, _action: Action, _stop: Stop | None = None) -> Transition:
        return Transition(state, Motion(1.0, stalled=True, largest_force=33.0))

    plan = confirmed_in(ONE, stalls, max_nodes=60)
    assert plan.status is Status.FAILED
    assert "when confirmed: the arm stalls at 33 N" in {node.closed for node in tree_of(plan).nodes}


def test_nothing_is_simulated_twice() -> None:
    """From the same state, in the same engine: neither here nor there."""
    for name in (HARD, "vieira/example-05", "papallas/s09", "papallas/s04"):
        scene = find_scene(name)
        with (
            PlanningWorld(WorldSpec(scene)) as world,
            PlanningWorld(WorldSpec(scene, backend_options=ELSEWHERE)) as other,
        ):
            here, there = Counted(world.apply), Counted(_grasps_fail_at_first(other.apply))
            task = task_in(world, confirm=there)
            task._apply = here
            plan = Sure(SureOptions()).plan(task)
        assert plan.status is Status.RETRIEVED
        assert len(set(here.asked)) == len(here.asked)
        assert len(set(there.asked)) == len(there.asked)


def _grasps_fail_at_first(apply: Apply) -> Apply:
    """The first three grasps come to nothing."""
    failed: list[Action] = []

    def confirm(state: State, action: Action, stop: Stop | None) -> Transition:
        if action.kind is ActionKind.GRASP and len(failed) < 3:
            failed.append(action)
            return Transition(state, Motion(1.0, stalled=True, largest_force=31.0))
        return apply(state, action, stop)

    return confirm


def test_the_plan_expects_what_the_engine_that_executes_makes_of_it() -> None:
    scene = SOME[0]
    with PlanningWorld(WorldSpec(scene, backend_options=ELSEWHERE)) as other:
        plan = confirmed_in(scene, other.apply)
        assert plan.status is Status.RETRIEVED
        assert len(plan.actions) >= 2
        state = scene.initial_state()
        for action, expected in zip(plan.actions, plan.expected, strict=True):
            state = other.apply(state, action).state
            np.testing.assert_array_equal(state.poses, expected.poses)


def elsewhere(name: str, **options: Any) -> Episode:
    """Planned in pymunk as it is, executed in another."""
    return solve(name, planner="sure", options={"plan_backend": ELSEWHERE, "planner": options})


def apart(episode: Episode) -> list[float]:
    """How far the pushes of an episode led from where they were expected to (m)."""
    steps = [step for step in episode.steps if step.action.kind is ActionKind.PUSH and step.expected is not None]
    return [float(step.after.displacement(step.expected).max()) for step in steps if step.expected is not None]


def test_what_was_confirmed_is_what_happens() -> None:
    found = [elsewhere(name) for name in CONFIRMED]
    assert [(each.status, each.clean, len(each.plans)) for each in found] == [(Status.RETRIEVED, True, 1)] * len(found)
    pushed = [distance for episode in found for distance in apart(episode)]
    assert len(pushed) >= 2
    assert max(pushed) <= 1e-6


def test_without_confirmation_reality_differs() -> None:
    assert max(distance for name in CONFIRMED for distance in apart(elsewhere(name, confirm=False))) > 1e-4
