"""The motion planner of arms of joints gives the same bits for the same inputs, however busy the machine is."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pinocchio")
pytest.importorskip("ompl")
pytest.importorskip("toppra")

from phframe.core import BasePose, FloatArray, GripperPath, JointTrajectory, MotionPlanner, State, Unreachable
from phframe.motion.budget import SearchBudget
from phframe.motion.edges import Edges
from tests.motion.motions import (
    CROWD,
    EMPTY,
    MIDDLE,
    SHELF,
    arm_state,
    baxter,
    bits,
    halfway,
    insertion,
    paths,
    planned,
    planner,
)

pytestmark = [pytest.mark.needs_baxter, pytest.mark.needs_ompl]

NEVER = 10**9


@pytest.mark.parametrize("kind", ["sweep", "angled", "grasp"])
def test_the_same_inputs_give_the_same_bits_whatever_was_planned_before(kind: str) -> None:
    arm = baxter()
    path = paths(arm)[kind]
    fresh, used = planner(arm, CROWD), planner(arm, CROWD)
    moved = CROWD.initial_state().poses.copy()
    moved[:2, 0], moved[:2, 1] = 0.05, (MIDDLE - 0.11, MIDDLE + 0.11)  # where the forearm has to keep off them
    for other in ("straight", "grasp"):
        planned(used, paths(arm)[other], State(moved, CROWD.initial_state().conditions), seed=3)
    assert bits(planned(fresh, path)) == bits(planned(used, path)) == bits(planned(used, path))


def test_where_the_time_is_up_it_says_so() -> None:
    arm = baxter()
    state = EMPTY.initial_state()
    found = planner(arm).plan(insertion(arm, 0.4, MIDDLE), state, attempts=1, seconds=0.0, rng=np.random.default_rng(0))
    assert isinstance(found, Unreachable)
    assert found.timed_out
    assert found.why == "no motion was found in the 0 s allowed"


ASIDE = BasePose(-0.675, MIDDLE - 0.35, -0.15, 0.0)
"""Where a way around has to be searched for."""


def turned(ours: MotionPlanner[Any]) -> tuple[GripperPath, State]:
    """No motion at the path's own yaw."""
    return insertion(ours.arm, 0.4, SHELF.width - 0.0625), CROWD.initial_state()


def blocked(ours: MotionPlanner[Any]) -> tuple[GripperPath, State]:
    """No motion at all."""
    return insertion(ours.arm, 0.45, 0.02), CROWD.initial_state()


def searched(ours: MotionPlanner[Any]) -> tuple[GripperPath, State]:
    """From inside the shelf, so that the way to where the path begins is not straight."""
    q = halfway(ours, insertion(ours.arm, 0.4, MIDDLE - 0.05), 0.35)
    return insertion(ours.arm, 0.3, MIDDLE + 0.12), replace(CROWD.initial_state(), arm=arm_state(ours, q))


@pytest.mark.parametrize("problem", [turned, blocked, searched])
def test_the_clock_changes_no_result_but_to_say_that_the_time_was_up(
    problem: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a clock that says that the time is up from one look at it on, whichever it is."""
    ours, looks = planner(baxter(), CROWD, ASIDE), [0]
    path, state = problem(ours)
    usual = result(lifted_by(ours, path, state, monkeypatch, looks, NEVER))
    asked, ends = looks[0], []
    for late in sorted({1, 2, asked // 2, asked - 1, asked}):
        found = lifted_by(ours, path, state, monkeypatch, looks, late)
        ends.append(isinstance(found, Unreachable) and found.timed_out)
        assert ends[-1] or result(found) == usual
    assert ends == [True] * (len(ends) - 1) + [False], "whoever looks and sees that the time is up ends"


def lifted_by(
    ours: MotionPlanner[Any],
    path: GripperPath,
    state: State,
    monkeypatch: pytest.MonkeyPatch,
    looks: list[int],
    late: int,
) -> JointTrajectory | Unreachable:
    """Planned by a clock that jumps ahead after so many looks at it."""
    looks[0] = 0

    def clock() -> float:
        looks[0] += 1
        return 0.0 if looks[0] <= late else 1e9

    monkeypatch.setattr("phframe.motion.budget.time.monotonic", clock)
    return planned(ours, path, state)


def result(found: JointTrajectory | Unreachable) -> object:
    return found if isinstance(found, Unreachable) else bits(found)


def test_the_search_was_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else the test above would not have tried the clock within OMPL."""
    ours, asked = planner(baxter(), CROWD, ASIDE), []
    path, state = searched(ours)
    allowed = Edges.allowed

    def counted(edges: Edges, start: FloatArray, end: FloatArray) -> bool:
        asked.append(end)
        return allowed(edges, start, end)

    monkeypatch.setattr(Edges, "allowed", counted)
    planned(ours, path, state)
    assert len(asked) > 20


def test_each_search_has_half_of_the_iterations_that_are_left() -> None:
    budget = SearchBudget(10, math.inf)
    counts = []
    for _ in range(4):
        stop = budget.search()
        counts.append(sum(1 for _ in iter(stop, True)))
        assert stop(), "it is over"
    assert counts == [5, 3, 1, 1]
    assert budget.search()()
    assert not budget.timed_out


def test_a_clock_that_stopped_anyone_is_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr("phframe.motion.budget.time.monotonic", lambda: now[0])
    budget = SearchBudget(100, 10.0)
    stop = budget.search()
    assert not stop()
    now[0] = 10.1
    assert not budget.timed_out, "nobody was stopped by it yet"
    assert stop()
    now[0] = 0.0
    assert budget.timed_out
    assert budget.expired()
