"""What the paper leaves open is settled as specified, each time by name."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from phframe.core import Shelf
from phframe.pushing.deviation import Deviation
from tests.pushing.parts import ARM, RADIUS, gap_to_walls, highest, often
from tests.pushing.sweep_cases import Case, cases, millimetres

WIDE = Shelf(0.6, 0.6)


def at(case: Case, depth: float, y: float, tilt: float) -> float:
    """Between the arm and the walls with its fingertip at a place in the corridor (m)."""
    tip = case.corridor.to_shelf(np.array([depth, y]))
    return gap_to_walls(ARM.closed, np.array([*tip, case.corridor.angle + tilt]), case.shelf)


def test_a_lane_too_narrow_for_the_arm_is_as_near_to_the_rectangle_as_fits() -> None:
    case = Case(WIDE, (0.45, 0.13), np.array([[0.3, 0.14], [0.2, 0.14]]))
    push = case.fitted(1, 0.0)
    assert push is not None
    assert push.deviations == (Deviation.LANE_CLAMPED,)
    assert push.sweep.lane == pytest.approx(0.06 + 0.002, abs=1e-5)


def test_a_sweep_too_near_to_the_wall_ends_where_the_arm_fits() -> None:
    case = Case(Shelf(0.6, 0.5), (0.45, 0.376), np.array([[0.3, 0.38], [0.05, 0.38]]))
    push = case.fitted(1, 0.0)
    assert push is not None
    assert Deviation.SWEEP_CLAMPED in push.deviations
    assert push.sweep.end <= 0.5 - 0.06 - 0.002 + 1e-9


@often
@given(cases())
def test_clamped_at_a_wall_the_arm_or_what_it_pushes_is_at_the_wall(case: Case) -> None:
    for push in case.pushes:
        sweep = push.sweep
        if Deviation.LANE_CLAMPED in push.deviations and Deviation.LANE_SHIFTED not in push.deviations:
            beyond = sweep.lane - sweep.direction * 0.002
            assert at(case, sweep.depth, beyond, sweep.tilt) < 0.002
        if Deviation.SWEEP_CLAMPED in push.deviations:
            beyond = sweep.end + sweep.direction * 0.002
            squeezed = _room(case, sweep.end, sweep.direction, sweep.depth, sweep.tilt) < RADIUS + 1e-6
            assert squeezed or at(case, sweep.depth, beyond, sweep.tilt) < 0.002


def _room(case: Case, end: float, direction: int, depth: float, tilt: float) -> float:
    front = max(float(c) for outline in ARM.closed for c in (outline.vertices @ [math.cos(tilt), -math.sin(tilt)]))
    depths = np.minimum(case.local[:, 0] - depth, front - 1e-9)
    ends = end + direction * (np.array([highest(ARM.closed, tilt, d, direction) for d in depths]) + RADIUS)
    across = case.corridor.to_shelf(np.column_stack([case.local[:, 0], ends]))[:, 1]
    return float(np.minimum(across, case.shelf.width - across).min())


@often
@given(millimetres(0.25, 0.4), millimetres(-0.03, 0.03))
def test_beside_a_target_that_keeps_the_fingertip_out_the_lane_gives_way(x: float, offset: float) -> None:
    """Level with the target, as what blocks a grasp is, nothing is touched at the depth that the target allows."""
    case = Case(WIDE, (x, 0.3), np.array([[x, 0.3 + 0.07 + abs(offset)], [x, 0.3 + 0.075 + abs(offset)]]))
    push = case.fitted(1, 0.0)
    assert push is not None
    sweep = push.sweep
    beside = sweep.lane - 0.009 - 0.3
    if Deviation.LANE_SHIFTED in push.deviations:
        assert beside == pytest.approx(1.2 * RADIUS, abs=1e-5)
        assert sweep.depth == x
    else:
        assert math.hypot(x - sweep.depth, max(beside, 0.0)) >= 1.2 * RADIUS - 1e-9


def test_the_fingertip_goes_less_deep_before_it_gives_way() -> None:
    """Just before the target, what is in front of it can still be pushed from 1.2 radii away."""
    case = Case(WIDE, (0.4, 0.3), np.array([[0.4 - 0.062, 0.31], [0.38, 0.37]]))
    push = case.fitted(1, 0.0)
    assert push is not None
    assert Deviation.LANE_SHIFTED not in push.deviations
    assert push.sweep.depth == pytest.approx(0.4 - 1.2 * RADIUS)


def test_beside_the_target_the_fingertip_goes_as_deep_as_1_2_radii_allow() -> None:
    """The finger's near side passes the target's centre line at 3 cm."""
    case = Case(WIDE, (0.4, 0.3), np.array([[0.4, 0.3 + 0.03 + 0.009 + 0.009 + RADIUS + 0.005]]))
    push = case.fitted(1, 0.0)
    assert push is not None
    assert push.deviations == ()
    assert push.sweep.depth == pytest.approx(0.4 - math.sqrt(0.036**2 - 0.03**2))


def test_beside_a_wall_the_arm_tilts_where_that_clears() -> None:
    """The corridor is angled, so that a straight arm's link meets the mouth's wall."""
    case = Case(WIDE, (0.45, 0.55), np.array([[0.25, 0.4]]))
    tilted = [push for push in case.pushes if push.sweep.tilt]
    assert tilted
    for push in tilted:
        straight = case.fitted(push.sweep.direction, 0.0)
        assert Deviation.TILTED in push.deviations
        assert straight is None or not straight.clears
        smaller = [t for t in map(math.radians, (10, -10, 20, -20)) if abs(t) < abs(push.sweep.tilt) - 1e-9]
        assert not any((fit := case.fitted(push.sweep.direction, t)) and fit.clears for t in smaller)
