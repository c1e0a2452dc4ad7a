"""Whatever the component and the corridor, every sweep proposed keeps the rules of a sweep."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from phframe.core import FloatArray, Outline, Shelf
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.pushing import Deviation, PushingOptions
from phframe.pushing.sweep_generator import TILTS
from phframe.pushing.tilted_sweep import Direction, Push
from tests.pushing.parts import ARM, HALF_WIDTH, RADIUS, boundary, gap_to_walls, gaps_to_points, highest, often, posed
from tests.pushing.sweep_cases import Case, cases

KEEP_OFF = 1.2 * RADIUS
OTHER = {Deviation.OTHER_DIRECTION, Deviation.SPANS_CORRIDOR}
HAMMER = (
    Outline("head", np.array([[-0.04, -0.08], [0.0, -0.08], [0.0, 0.08], [-0.04, 0.08]])),
    Outline("handle", np.array([[-1.3, -0.015], [-0.04, -0.015], [-0.04, 0.015], [-1.3, 0.015]])),
)
"""Wider in front than behind, unlike the planar arm: it can be in a place that it cannot come straight out of."""
directions: st.SearchStrategy[Direction] = st.sampled_from([1, -1])
tilts = st.sampled_from(TILTS)
anything = st.one_of(cases(), cases(straight=True), cases(inside=False))


def fingertip_poses(case: Case, push: Push, count: int = 5) -> FloatArray:
    """Poses ``(k, 3)`` in the shelf frame along the way in, across and out."""
    corners = case.corridor.to_shelf(push.sweep.waypoints)
    legs = [a + np.linspace(0, 1, count)[:, None] * (b - a) for a, b in pairwise(corners)]
    positions = np.concatenate(legs)
    return np.column_stack([positions, np.full(len(positions), case.corridor.angle + push.sweep.tilt)])


def pushed(case: Case, push: Push) -> FloatArray:
    """Where the members' centres ``(k, 2)`` end: one radius ahead of the leading side at their depth."""
    sweep, front = push.sweep, posed(boundary(ARM.closed), 0.0, 0.0, push.sweep.tilt)[:, 0].max()
    depths = np.minimum(case.local[:, 0] - sweep.depth, front - 1e-9)
    sides = np.array([highest(ARM.closed, sweep.tilt, depth, sweep.direction) for depth in depths])
    return np.column_stack([case.local[:, 0], sweep.end + sweep.direction * (sides + RADIUS)])


def nearest(case: Case, push: Push) -> float:
    """The least distance (m) between the arm, on its way in and across, and the centre of a member."""
    arm = posed(boundary(ARM.closed), 0.0, 0.0, push.sweep.tilt)
    distances = []
    for start, end in pairwise(push.sweep.waypoints[:3]):
        for member in case.local - start:
            along = np.clip((member - arm) @ (end - start) / ((end - start) @ (end - start)), 0.0, 1.0)
            distances.append(np.linalg.norm(member - arm - along[:, None] * (end - start), axis=1).min())
    return float(min(distances))


@often
@given(anything, directions, tilts)
def test_the_arm_keeps_its_margin_from_the_walls_all_the_way(case: Case, direction: Direction, tilt: float) -> None:
    for outlines in (ARM.closed, HAMMER):
        push = case.fitted(direction, tilt, outlines)
        if push is not None:
            for pose in fingertip_poses(case, push):
                assert gap_to_walls(outlines, pose, case.shelf) >= PushingOptions().wall_clearance - 1e-6


@often
@given(anything)
def test_the_arm_begins_and_ends_before_the_mouth(case: Case) -> None:
    for push in case.pushes:
        poses = fingertip_poses(case, push)
        for pose in (poses[0], poses[-1]):
            assert posed(boundary(ARM.closed), *pose)[:, 0].max() == pytest.approx(-0.05, abs=1e-9)


@often
@given(anything)
def test_the_fingertip_sweeps_no_nearer_to_the_target_than_1_2_radii(case: Case) -> None:
    corridor = case.corridor
    target = np.array([corridor.end, corridor.axis])
    for push in case.pushes:
        sweep = push.sweep
        south, north = (highest(ARM.closed, sweep.tilt, 0.0, way) for way in (-1, 1))
        low, high = min(sweep.lane, sweep.end) - south, max(sweep.lane, sweep.end) + north
        y = np.array([low, high, np.clip(target[1], low, high)])
        nearest = np.hypot(sweep.depth - target[0], y - target[1]).min()
        assert nearest >= KEEP_OFF - 1e-9


@often
@given(anything)
def test_the_sweep_goes_in_its_direction_and_reaches_the_nearest_member(case: Case) -> None:
    for push in case.pushes:
        sweep = push.sweep
        assert (sweep.end - sweep.lane) * sweep.direction >= 1e-3
        assert case.local[:, 0].min() - 0.9 * RADIUS < sweep.depth <= case.local[:, 0].max() + 1e-12
        assert sweep.tilt in TILTS
        assert (Deviation.TILTED in push.deviations) is (sweep.tilt != 0.0)


@pytest.mark.parametrize(
    ("shelf", "target", "members", "direction", "degrees"),
    [
        (Shelf(0.548, 0.417), (0.293, 0.034), [[0.343, 0.049]], -1, 0.0),
        (Shelf(0.461, 0.464), (0.378, 0.338), [[0.398, 0.218], [0.37, 0.314]], -1, 30.0),
    ],
)
def test_a_sweep_that_would_end_where_it_begins_or_before_is_not_proposed(
    shelf: Shelf, target: tuple[float, float], members: list[list[float]], direction: Direction, degrees: float
) -> None:
    assert Case(shelf, target, np.array(members)).fitted(direction, math.radians(degrees)) is None


@often
@given(anything)
def test_the_arm_meets_a_member_on_its_way_in_or_across(case: Case) -> None:
    for push in case.pushes:
        assert nearest(case, push) < RADIUS + 1e-4


@pytest.mark.parametrize(
    ("target", "member", "direction", "tilt"),
    [
        ((0.478, 0.189), (0.472, 0.097), 1, 0.0),  # the lane, shifted past the target, is beyond the member
        ((0.414, 0.141), (0.403, 0.030), 1, 0.0),  # the lane, clamped to the wall, is beyond the member
        ((0.414, 0.141), (0.307, 0.059), 1, math.radians(10.0)),
        ((0.385, 0.471), (0.105, 0.580), 1, 0.0),  # clamped at both ends, it stops short of the member
    ],
)
def test_a_sweep_that_would_meet_no_member_is_not_proposed(
    target: tuple[float, float], member: tuple[float, float], direction: Direction, tilt: float
) -> None:
    case = Case(Shelf(0.6, 0.61), target, np.array([member]))
    assert case.fitted(direction, tilt) is None


@often
@given(cases())
def test_a_sweep_that_clears_leaves_every_member_outside_the_corridor_and_off_the_walls(case: Case) -> None:
    corridor = case.corridor
    for push in case.pushes:
        ends = pushed(case, push)
        across = corridor.to_shelf(ends)[:, 1]
        room = float(np.minimum(across, case.shelf.width - across).min()) - RADIUS
        assert room >= -1e-6, "squeezed into a wall"
        margin = float(((ends[:, 1] - corridor.axis) * push.sweep.direction).min()) - HALF_WIDTH
        if abs(margin) > 1e-6 and room > 1e-6:
            assert push.clears is (margin > 0.0)
        if push.clears:
            assert margin > -1e-6


def test_what_is_swept_up_to_the_wall_and_out_of_the_corridor_is_cleared() -> None:
    case = Case(Shelf(0.4, 0.4), (0.2, 0.03), np.array([[0.08489662, 0.11480898]]))
    pushes = {push.sweep.direction: push for push in case.pushes if Deviation.SWEEP_CLAMPED in push.deviations}
    ends = pushed(case, pushes[-1])
    assert (case.corridor.axis - ends[:, 1]).min() > HALF_WIDTH
    assert case.corridor.to_shelf(ends)[:, 1].min() == pytest.approx(RADIUS, abs=1e-6)
    assert pushes[-1].clears


@often
@given(anything)
def test_what_is_not_clamped_is_the_papers_sweep(case: Case) -> None:
    for push in case.pushes:
        sweep, rectangle = push.sweep, case.geometry.rectangle
        if Deviation.SWEEP_CLAMPED not in push.deviations:
            leading = (pushed(case, push)[:, 1] - case.corridor.axis) * sweep.direction - RADIUS
            assert leading.min() == pytest.approx(HALF_WIDTH + 1e-3, abs=1e-6)
        if not {Deviation.LANE_CLAMPED, Deviation.LANE_SHIFTED} & {*push.deviations}:
            inserted = np.array([sweep.depth, sweep.lane, sweep.tilt])
            assert gaps_to_points(ARM.closed, inserted, case.local).min() >= RADIUS - 1e-9
            near = rectangle.lower[1] if sweep.direction == 1 else rectangle.upper[1]
            widest = (near - sweep.lane) * sweep.direction - RADIUS - 0.005
            sampled = max(
                highest(ARM.closed, sweep.tilt, x - sweep.depth, sweep.direction)
                for x in np.linspace(rectangle.lower[0] - RADIUS, rectangle.upper[0] + RADIUS, 60)
            )
            assert widest >= sampled - 1e-9
            if sweep.tilt == 0.0:
                assert widest in [pytest.approx(width) for width in (0.009, 0.049, 0.06)]


@often
@given(anything)
@example(Case(Shelf(0.58, 0.504), (0.293, 0.158), np.array([[0.054, 0.299], [0.408, 0.045], [0.358, 0.221]])))
def test_at_most_two_are_proposed_in_each_direction_and_those_that_clear_come_first(case: Case) -> None:
    pushes = case.pushes
    clears = [push.clears for push in pushes]
    assert clears == sorted(clears, reverse=True)
    for direction in (1, -1):
        same = [push for push in pushes if push.sweep.direction == direction]
        assert [push.clears for push in same] in ([], [True], [False], [True, False])
        assert len({bool(OTHER & {*push.deviations}) for push in same}) <= 1
    for push in pushes:
        assert (Deviation.NOT_CLEARING in push.deviations) is not push.clears
    ranks = [(not push.clears, push.clears and push.rams) for push in pushes]
    assert ranks == sorted(ranks), "what rams on its way in comes after what does not"
    for rank in set(ranks):
        part = [push for push, its in zip(pushes, ranks, strict=True) if its == rank]
        other = [bool(OTHER & {*push.deviations}) for push in part]
        assert other == sorted(other), "the paper's direction comes first"


@often
@given(anything, directions, tilts)
def test_north_and_south_are_mirror_images(case: Case, direction: Direction, tilt: float) -> None:
    push, other = case.fitted(direction, tilt), case.mirrored.fitted(-direction, -tilt)
    assert (push is None) is (other is None)
    if push is not None and other is not None:
        assert other.deviations == push.deviations
        one, two, axes = push.sweep, other.sweep, (case.corridor.axis, case.mirrored.corridor.axis)
        assert (two.depth, two.entry, two.exit) == pytest.approx((one.depth, one.entry, one.exit), abs=1e-9)
        offsets = (one.lane - axes[0], one.end - axes[0])
        assert (axes[1] - two.lane, axes[1] - two.end) == pytest.approx(offsets, abs=1e-9)


def test_a_sweep_up_to_the_margin_fits_on_both_sides() -> None:
    """The arm's side touches the margin at the mouth's corner, and moves along itself."""
    case = Case(Shelf(0.6, 0.626), (0.45, 0.064), np.array([[0.198, 0.205]]))
    fitted = case.fitted(1, 0.0), case.mirrored.fitted(-1, 0.0)
    assert [push is not None for push in fitted] == [True, True]


def test_however_far_from_the_corridor_the_lane_is_clamped_by_walls_alone() -> None:
    push = Case(Shelf(0.4, 0.8), (0.3, 0.15), np.array([[0.2, 0.65]])).fitted(-1, 0.0)
    assert push is not None
    assert Deviation.LANE_CLAMPED not in push.deviations
    assert push.sweep.lane == pytest.approx(0.65 + 0.009 + 0.03 + 0.005)


def test_the_sweep_of_a_lone_object_in_the_middle() -> None:
    case = Case(Shelf(0.6, 0.6), (0.45, 0.3), np.array([[0.25, 0.32]]))
    (push, *_) = case.pushes
    assert (push.deviations, push.clears) == ((), True)
    sweep = push.sweep
    assert (sweep.direction, sweep.depth, sweep.tilt) == (1, 0.25, 0.0)
    assert sweep.lane == pytest.approx(0.32 - 0.009 - 0.03 - 0.005)
    assert sweep.end == pytest.approx(0.3 + 0.12 + 0.001 - 0.009)
    assert sweep.entry == sweep.exit == pytest.approx(0.25 + 0.05)


@often
@given(anything)
def test_all_that_clear_are_the_clearing_ones_of_every_way(case: Case) -> None:
    clearing = case.geometry.all_clearing()
    ways: list[tuple[Direction, float]] = [(way, lean * way) for way in (1, -1) for lean in TILTS]
    ahead = [(way, tilt) for way, tilt in ways if math.cos(case.corridor.angle + tilt) >= LEAST_AHEAD]
    fitted = [case.fitted(*way) for way in ahead]
    expected = {push.sweep for push in fitted if push is not None and push.clears}
    assert len(clearing) == len({push.sweep for push in clearing})
    assert {push.sweep for push in clearing} == expected
    assert {push.sweep for push in case.pushes if push.clears} <= {push.sweep for push in clearing}
    assert all(push.clears for push in clearing)
    rams = [push.rams for push in clearing]
    assert rams == sorted(rams)
    for direction in (1, -1):
        for ram in (False, True):
            tilts = [
                abs(each.sweep.tilt) for each in clearing if each.sweep.direction == direction and each.rams is ram
            ]
            assert tilts == sorted(tilts), "the least tilt first"


@often
@given(anything, st.sampled_from([0.0, 10.0, 15.0, 20.0, 30.0]))
def test_no_tilt_is_greater_than_allowed_and_one_just_as_great_is(case: Case, degrees: float) -> None:
    allowed = PushingOptions(max_tilt=math.radians(degrees))
    within = [push for push in case.geometry.all_clearing() if abs(push.sweep.tilt) <= math.radians(degrees) + 1e-6]
    assert case.generator(allowed).all_clearing() == within


@often
@given(anything)
def test_where_there_is_no_room_outside_the_corridor_no_tilt_is_tried_in_vain(case: Case) -> None:
    corridor, depths = case.corridor, case.local[:, 0]
    for push in case.pushes:
        if push.sweep.tilt != 0.0:
            edge = np.full(len(depths), corridor.axis + push.sweep.direction * HALF_WIDTH)
            across = corridor.to_shelf(np.column_stack([depths, edge]))[:, 1]
            assert across.min() > RADIUS
            assert across.max() < case.shelf.width - RADIUS


@often
@given(anything)
@example(
    Case(Shelf(0.4, 0.4), (0.2, 0.281), np.array([[0.0, 0.03]]))
)  # nearest is the front of a wall, beside the mouth
def test_the_clearance_is_the_least_distance_from_walls_and_target(case: Case) -> None:
    target = np.array([case.target])
    for push in case.pushes:
        poses = fingertip_poses(case, push, 31)
        walls = min(gap_to_walls(ARM.closed, pose, case.shelf) for pose in poses)
        beside = min(float(gaps_to_points(ARM.closed, pose, target)[0]) for pose in poses) - RADIUS
        clearance = case.geometry.clearance(push)
        assert clearance <= min(walls, beside) + 1e-9
        assert clearance >= min(walls, beside) - 0.02, "no more than between two samples"


def test_a_lone_object_in_the_middle_has_all_six_neighbours_and_at_the_greatest_tilt_five() -> None:
    generator = Case(Shelf(0.6, 0.6), (0.45, 0.3), np.array([[0.25, 0.32]])).geometry
    steps = [(-RADIUS / 2.0, 0.0, 0.0), (RADIUS / 2.0, 0.0, 0.0), (0.0, -RADIUS / 2.0, 0.0), (0.0, RADIUS / 2.0, 0.0)]
    north = [push for push in generator.all_clearing() if push.sweep.direction == 1]
    for degrees, turned in ((0.0, (-10.0, 10.0)), (30.0, (-10.0,))):
        push = next(push for push in north if push.sweep.tilt == pytest.approx(math.radians(degrees)))
        sweep, found = push.sweep, [each.sweep for each in generator.neighbours(push)]
        changes = [(each.depth - sweep.depth, each.lane - sweep.lane, each.tilt - sweep.tilt) for each in found]
        expected = [*steps, *[(0.0, 0.0, math.radians(degrees)) for degrees in turned]]
        np.testing.assert_allclose(sorted(np.round(changes, 9).tolist()), sorted(expected), atol=1e-8)


@often
@given(anything)
def test_neighbours_keep_the_rules_of_a_sweep(case: Case) -> None:
    generator = case.geometry
    for push in generator.pushes():
        found = generator.neighbours(push)
        clears = [each.clears for each in found]
        assert clears == sorted(clears, reverse=True)
        for each in found:
            assert each.sweep != push.sweep
            assert each.sweep.direction == push.sweep.direction
            assert each.sweep.depth > case.local[:, 0].min() - 0.9 * RADIUS
            assert nearest(case, each) < RADIUS + 1e-4
            changed = (each.sweep.depth != push.sweep.depth) + (each.sweep.tilt != push.sweep.tilt)
            assert changed <= 1
            deeper, aside = each.sweep.depth - push.sweep.depth, each.sweep.lane - push.sweep.lane
            assert deeper == 0.0 or abs(deeper) == pytest.approx(RADIUS / 2.0)
            if not changed and Deviation.LANE_CLAMPED not in each.deviations:
                assert abs(aside) == pytest.approx(RADIUS / 2.0)
            for pose in fingertip_poses(case, each):
                assert gap_to_walls(ARM.closed, pose, case.shelf) >= PushingOptions().wall_clearance - 1e-6
        if Deviation.LANE_SHIFTED not in push.deviations:
            tilts = {abs(each.sweep.tilt - push.sweep.tilt) for each in found} - {0.0}
            assert all(tilt == pytest.approx(math.radians(10.0)) for tilt in tilts)
