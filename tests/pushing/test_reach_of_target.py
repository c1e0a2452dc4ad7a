"""Asked in an empty shelf, and only about the arm: what it cannot grasp is refused, at angles and as deep, with its reason."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import Action, Condition, Infeasible, State, Unreachable
from phframe.planners.sure import SureOptions
from phframe.pushing import WIDE_FAN, Drive, Grasp, Pushing, ReachOfTarget, drives
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import often, scene_of
from tests.pushing.worlds import task_in

CROWD = ((0.25, 0.3), (0.25, 0.365), (0.25, 0.235), (0.3, 0.17), (0.3, 0.43))
SCENE = scene_of((0.45, 0.3), *CROWD)


class Arm:
    """One that reaches yaws above a least one and fingertips up to a depth, and notes in which states it was asked.

    Args:
        least: The yaw (rad).
        deepest: How deep the fingertips may go into the shelf (m).
    """

    def __init__(self, least: float = -math.inf, deepest: float = math.inf) -> None:
        self._least, self._deepest = least, deepest
        self.asked: list[State] = []

    def __call__(self, state: State, action: Action) -> Unreachable | None:
        self.asked.append(state)
        inside = action.path.poses[0, 2] > self._least and action.path.poses[1, 0] <= self._deepest
        return None if inside else Unreachable(0.1, "joint 4 at its limit")


@contextmanager
def reach_of(
    arm: Arm, target: tuple[float, float] = (0.45, 0.3), crowd: bool = True
) -> Iterator[tuple[ReachOfTarget, list[Drive], State]]:
    scene = scene_of(target, *(CROWD if crowd else ()))
    with PlanningWorld(WorldSpec(scene)) as world:
        task = task_in(world, reach=arm)
        pushing = Pushing(task, SureOptions())
        found = drives(pushing, task.start, WIDE_FAN)
        assert not isinstance(found, Infeasible)
        yield ReachOfTarget(task, pushing, WIDE_FAN), found, task.start


def test_nothing_is_refused_before_it_is_asked() -> None:
    arm = Arm(math.inf)
    with reach_of(arm) as (reach, found, _):
        assert not any(reach.refuses(drive) for drive in found)
        assert (reach.never, arm.asked) == ("", [])


def test_what_the_arm_cannot_grasp_in_an_empty_shelf_is_refused_and_nothing_else() -> None:
    arm = Arm(math.radians(-10.0))
    with reach_of(arm) as (reach, found, start):
        for drive, action in graspable(found):
            reach.ask(start, drive, action)
        assert reach.never == ""
        refused = {round(math.degrees(drive.angle)) for drive in found if reach.refuses(drive)}
        assert {-15, -30} & {round(math.degrees(drive.angle)) for drive, _ in graspable(found)} <= refused
        assert refused.isdisjoint({0, 15, 30})
        for _, action in graspable(found):
            assert (reach.rejects(start)(action) is not None) == (action.path.poses[1, 2] <= math.radians(-10.0))


def test_less_deep_grasps_take_the_place_of_those_that_are_too_deep() -> None:
    arm = Arm(deepest=0.458)
    with reach_of(arm, crowd=False) as (reach, found, start):
        (drive, action), *_ = graspable(found)
        assert action.path.poses[1, 0] == pytest.approx(0.47)
        reach.ask(start, drive, action)
        assert not reach.refuses(drive)
        again = drives_of(reach, start)
        straight = next(each.grasp for each in again if each.angle == drive.angle)
        assert isinstance(straight, Grasp)
        assert straight.action.path.poses[1].tolist() == pytest.approx([0.454, 0.3, 0.0])


@pytest.mark.parametrize(
    ("arm", "asked", "rejected"),
    [
        (Arm(math.radians(-10.0)), -15, {-15}),  # at no depth: up to 5.5 degrees beside it
        (Arm(deepest=0.458), 0, {-15, 0, 15}),  # not as deep: up to 15.5 degrees beside it
    ],
    ids=["at no depth", "not as deep"],
)
def test_what_is_known_of_one_yaw_holds_for_those_beside_it(arm: Arm, asked: int, rejected: set[int]) -> None:
    with reach_of(arm, crowd=False) as (reach, found, start):
        by_degrees = {round(math.degrees(drive.angle)): (drive, action) for drive, action in graspable(found)}
        assert {-30, -15, 0, 15, 30} <= set(by_degrees)
        reach.ask(start, *by_degrees[asked])
        rejects = reach.rejects(start)
        assert {degrees for degrees, (_, action) in by_degrees.items() if rejects(action) is not None} == rejected


def test_it_asks_in_a_shelf_without_obstacles_and_each_question_once() -> None:
    arm = Arm(0.0)
    with reach_of(arm) as (reach, found, start):
        for drive, action in graspable(found):
            reach.ask(start, drive, action)
        assert len(arm.asked) == reach.questions
        for state in arm.asked:
            assert state.arm is None
            assert state.conditions[0] is Condition.UPRIGHT
            assert set(state.conditions[1:]) == {Condition.SPILLED}
            np.testing.assert_array_equal(state.poses[0], start.poses[0])
            assert (state.positions[1:, 0] < -1.0).all()


def test_an_arm_that_only_obstacles_keep_from_a_grasp_is_known_to_reach_it() -> None:
    arm = Arm()
    with reach_of(arm, crowd=False) as (reach, found, start):
        (drive, action), *_ = graspable(found)
        reach.ask(start, drive, action)
        assert reach.questions == 1
        assert not reach.refuses(drive)
        assert reach.rejects(start)(action) is None


def test_what_is_known_holds_where_the_target_stood_and_not_elsewhere() -> None:
    with reach_of(Arm(math.inf), crowd=False) as (reach, found, start):
        (drive, action), *_ = graspable(found)
        reach.ask(start, drive, action)
        assert all(reach.refuses(each) for each, _ in graspable(found))
        poses = start.poses.copy()
        poses[0, 1] += 0.05
        elsewhere = replace(start, poses=poses)
        assert not any(reach.refuses(each) for each in drives_of(reach, elsewhere))


@often
@given(st.tuples(st.floats(0.1, 0.55), st.floats(0.032, 0.568)))
def test_why_it_never_reaches_is_told_of_the_arm(target: tuple[float, float]) -> None:
    """A wall that blocks some of the angles is no reason."""
    arm = Arm(math.inf)
    with reach_of(arm, target, crowd=False) as (reach, found, start):
        for drive, action in graspable(found)[:1]:
            reach.ask(start, drive, action)
            assert reach.never.endswith("even in an empty shelf: joint 4 at its limit")
            assert all(reach.refuses(each) for each, _ in graspable(found))
            assert reach.questions <= 3 * len(found) + 1


def graspable(found: list[Drive]) -> list[tuple[Drive, Action]]:
    return [(drive, drive.grasp.action) for drive in found if isinstance(drive.grasp, Grasp)]


def drives_of(reach: ReachOfTarget, state: State) -> list[Drive]:
    found = drives(reach._pushing, state, WIDE_FAN, reach.rejects(state))
    assert not isinstance(found, Infeasible)
    return found
