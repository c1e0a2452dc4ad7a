"""With the paper's sweeps there is one for a component: Algorithm 3's, kept off walls and target, whatever it comes to."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given

from phframe.core import Action, ActionKind, Motion, Shelf, State, Status, Transition
from phframe.pushing import Deviation, PushingOptions, SweepGenerator
from phframe.pushing.tilted_sweep import Push
from tests.pushing.parts import ARM, HALF_WIDTH, RADIUS, highest, often
from tests.pushing.sweep_cases import Case, cases
from tests.pushing.test_clearing import BLOCKED, aside, moved, plan

WIDE = Shelf(0.6, 0.6)


def paper(case: Case) -> list[Push]:
    options = PushingOptions(sweeps="paper")
    return list(SweepGenerator(case.corridor, case.local, RADIUS, RADIUS, case.view, options).pushes())


@often
@given(cases())
def test_there_is_at_most_one_straight_in_the_papers_direction_clamped_to_walls_only(case: Case) -> None:
    pushes = paper(case)
    assert len(pushes) <= 1
    for push in pushes:
        offset = float(case.geometry.rectangle.center[1]) - case.corridor.axis
        assert push.sweep.tilt == 0.0
        assert offset == 0.0 or push.sweep.direction == math.copysign(1, offset)
        assert set(push.deviations) <= {Deviation.LANE_CLAMPED, Deviation.SWEEP_CLAMPED}


@often
@given(cases())
def test_the_fingertip_keeps_off_the_target_and_goes_no_deeper_than_the_rectangle(case: Case) -> None:
    for push in paper(case):
        sweep, corridor = push.sweep, case.corridor
        south, north = (highest(ARM.closed, 0.0, 0.0, way) for way in (-1, 1))
        low, high = min(sweep.lane, sweep.end) - south, max(sweep.lane, sweep.end) + north
        beside = max(low - corridor.axis, corridor.axis - high, 0.0)
        assert math.hypot(corridor.end - sweep.depth, beside) >= 1.2 * RADIUS - 1e-9
        assert sweep.depth <= case.geometry.rectangle.upper[0] + 1e-12


@often
@given(cases())
def test_where_the_papers_sweep_needs_no_deviation_it_is_the_first_fitted_one(case: Case) -> None:
    first = next(iter(case.pushes), None)
    if first is not None and not first.deviations:
        assert paper(case) == [first]


def test_it_sweeps_to_the_corridors_edge_from_beside_the_rectangle_at_its_far_edge() -> None:
    case = Case(WIDE, (0.5, 0.3), np.array([[0.2, 0.29], [0.25, 0.33]]))
    [push] = paper(case)
    assert (push.sweep.direction, push.sweep.depth, push.deviations) == (1, 0.25, ())
    leading = min(highest(ARM.closed, 0.0, x - 0.25, 1) for x in (0.2, 0.25))
    assert push.sweep.end + leading == 0.3 + HALF_WIDTH + 0.001


def test_what_the_target_keeps_it_from_is_missed() -> None:
    """Level with the target, the fitted lane would be shifted; the paper's sweep stops short of the object."""
    case = Case(WIDE, (0.3, 0.3), np.array([[0.3, 0.37]]))
    [push] = paper(case)
    assert push.sweep.depth < 0.3 - RADIUS
    assert all(Deviation.LANE_SHIFTED in other.deviations for other in case.pushes if other.sweep.direction == 1)


def test_a_sweep_that_moves_nothing_is_a_failure_without_a_second_try() -> None:
    found = plan(BLOCKED, lambda state, action: Transition(state, Motion(1.0)), sweeps="paper")
    assert (found.status, found.reason) == (Status.FAILED, "nothing moved: sweep north: o0")
    assert found.cost.simulated_actions == 1


def test_a_sweep_that_stalls_is_followed() -> None:
    def answer(state: State, action: Action) -> Transition:
        if action.kind is ActionKind.GRASP:
            return aside(state, action)
        return Transition(moved(state, 1, (0.0, 0.15)), Motion(1.0, stalled=True))

    found = plan(BLOCKED, answer, sweeps="paper")
    assert found.status is Status.RETRIEVED
    assert found.tree is not None
    assert [node.closed for node in found.tree.nodes] == ["", "", ""]
    assert Deviation.NEXT_SWEEP not in found.deviations
