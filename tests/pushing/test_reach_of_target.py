"""Asked once at every angle in an empty shelf, and only about the arm: what it cannot grasp is refused, with its reason."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
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
    """One that reaches yaws above a least one, and notes in which states it was asked.

    Args:
        least: The yaw (rad).
    """

    def __init__(self, least: float) -> None:
        self._least = least
        self.asked: list[State] = []

    def __call__(self, state: State, action: Action) -> Unreachable | None:
        self.asked.append(state)
        return None if action.path.poses[0, 2] > self._least else Unreachable(0.1, "joint 4 at its limit")


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
        reach.ask(start)
        assert reach.never == ""
        refused = {round(math.degrees(drive.angle)) for drive in found if reach.refuses(drive)}
        assert {-15, -30} <= refused
        assert refused.isdisjoint({0, 15, 30})


def test_it_asks_in_a_shelf_without_obstacles_and_once() -> None:
    arm = Arm(0.0)
    with reach_of(arm) as (reach, _, start):
        reach.ask(start)
        number = len(arm.asked)
        reach.ask(start)
        assert len(arm.asked) == number <= len(WIDE_FAN) + 1
        for state in arm.asked:
            assert state.arm is None
            assert state.conditions[0] is Condition.UPRIGHT
            assert set(state.conditions[1:]) == {Condition.SPILLED}
            np.testing.assert_array_equal(state.poses[0], start.poses[0])
            assert (state.positions[1:, 0] < -1.0).all()


@often
@given(st.tuples(st.floats(0.1, 0.55), st.floats(0.032, 0.568)))
def test_why_it_never_reaches_is_told_of_the_arm(target: tuple[float, float]) -> None:
    """A wall that blocks some of the angles is no reason."""
    arm = Arm(math.inf)
    with reach_of(arm, target, crowd=False) as (reach, found, start):
        reach.ask(start)
        assert len(arm.asked) == sum(isinstance(drive.grasp, Grasp) for drive in found)
        assert all(reach.refuses(drive) for drive in found)
        if arm.asked:
            assert reach.never.endswith("even in an empty shelf: joint 4 at its limit")
