"""Drives at any angle: the strip leads through the target, nothing inside the shelf is left out, north and south are alike."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import Condition, Infeasible, Shelf
from phframe.pushing import WIDE_FAN, Grasp, corridor_at, drives, find_corridor
from phframe.pushing.fan import SAME_ANGLE
from tests.pushing.parts import mirrored, often, places, scene_of, shelves
from tests.pushing.worlds import Bench, bench

angles = st.floats(-math.radians(60.0), math.radians(60.0))
widths = st.floats(0.03, 0.15)


@often
@given(st.data(), angles, widths)
def test_its_axis_leads_from_the_mouth_plane_through_the_target_at_its_angle(
    data: st.DataObject, angle: float, width: float
) -> None:
    target = np.array(data.draw(places(data.draw(shelves()))))
    corridor = corridor_at(angle, target, width)
    np.testing.assert_allclose(corridor.to_shelf(np.array([corridor.end, corridor.axis])), target, atol=1e-12)
    assert corridor.origin[0] == pytest.approx(0.0, abs=1e-12)
    ahead = corridor.to_shelf(np.array([[0.0, corridor.axis], [1.0, corridor.axis]]))
    along = ahead[1] - ahead[0]
    assert math.atan2(along[1], along[0]) == pytest.approx(angle)
    assert (corridor.angle, corridor.half_width, corridor.beside) == (angle, width, None)


@often
@given(st.data(), angles, widths)
def test_all_of_the_strip_between_mouth_and_target_is_in_it(data: st.DataObject, angle: float, width: float) -> None:
    """Against its definition by the distance from a line: no frame, no start."""
    target = np.array(data.draw(places(data.draw(shelves()), 0.05)))
    corridor = corridor_at(angle, target, width)
    number = data.draw(st.integers(0, 1000))
    points = np.random.default_rng(number).uniform([0.0, -0.5], [0.8, 1.4], (300, 2))
    ahead = np.array([math.cos(angle), math.sin(angle)])
    across = (points - target) @ np.array([-ahead[1], ahead[0]])
    wanted = (np.abs(across) <= width) & ((points - target) @ ahead < 0.0)
    clear = (np.abs(np.abs(across) - width) > 1e-9) & (np.abs((points - target) @ ahead) > 1e-9)
    assert (corridor.contains(points) == wanted)[clear].all()


@often
@given(st.data(), angles, widths)
def test_north_and_south_are_alike(data: st.DataObject, angle: float, width: float) -> None:
    shelf = data.draw(shelves())
    target = np.array(data.draw(places(shelf, 0.05)))
    points = np.random.default_rng(0).uniform([0.0, 0.0], [shelf.depth, shelf.width], (100, 2))
    there = np.array([0.0, shelf.width]) + points * [1.0, -1.0]
    north = corridor_at(angle, target, width)
    south = corridor_at(-angle, np.array([target[0], shelf.width - target[1]]), width)
    assert (north.contains(points) == south.contains(there)).mean() >= 0.99
    np.testing.assert_allclose(north.to_local(points) * [1.0, -1.0], south.to_local(there), atol=1e-9)
    assert (north.start, north.end) == pytest.approx((south.start, south.end))


@often
@given(st.data())
def test_straight_ahead_it_is_the_paper_s(data: st.DataObject) -> None:
    target = np.array(data.draw(places(scene_of((0.3, 0.3)).shelf, 0.05)))
    paper = find_corridor(target, scene_of((0.3, 0.3)).shelf, 0.03)
    ours = corridor_at(0.0, target, 0.03)
    points = np.random.default_rng(1).uniform(0.0, 0.6, (200, 2))
    assert not isinstance(paper, Infeasible)
    assert (paper.contains(points) == ours.contains(points)).all()


def test_past_the_target_it_leads_as_far_as_asked() -> None:
    near, far = (corridor_at(0.3, np.array([0.4, 0.3]), 0.05, beyond) for beyond in (0.0, 0.1))
    behind = np.array([[0.4, 0.3]]) + 0.05 * np.array([[math.cos(0.3), math.sin(0.3)]])
    assert (near.contains(behind).item(), far.contains(behind).item()) == (False, True)


# --- Drives ---

BLOCKED = scene_of((0.4, 0.3), (0.1, 0.3))


def test_the_paper_s_corridor_comes_first_and_no_angle_twice() -> None:
    for scene in (BLOCKED, scene_of((0.45, 0.08), (0.2, 0.2)), scene_of((0.45, 0.52), (0.2, 0.2))):
        with bench(scene) as made:
            found = made.drives(*WIDE_FAN)
            paper = made.pushing.problem(made.task.start)
        assert not isinstance(paper, Infeasible)
        assert found[0].angle == paper.corridor.angle
        apart = np.abs(np.subtract.outer(*[[drive.angle for drive in found]] * 2))
        assert (apart[~np.eye(len(found), dtype=bool)] >= SAME_ANGLE).all()
        straight = abs(paper.corridor.angle) < SAME_ANGLE
        assert len(found) == len(WIDE_FAN) + (not straight)


def test_where_the_paper_has_no_corridor_the_fan_has_its_drives() -> None:
    """The shelf is narrower than the paper's corridor."""
    with bench(scene_of((0.3, 0.1), shelf=Shelf(depth=0.6, width=0.2)), half_width=0.12) as made:
        assert isinstance(made.pushing.problem(made.task.start), Infeasible)
        assert [drive.angle for drive in made.drives(*WIDE_FAN)] == list(WIDE_FAN)


def test_an_angle_at_which_the_gripper_would_not_go_in_is_left_out() -> None:
    straight, steep, aside = 0.0, math.acos(0.21), math.acos(0.19)
    with bench(BLOCKED) as made:
        found = made.drives(straight, steep, -steep, aside, -aside, math.pi)
    assert [drive.angle for drive in found] == [straight, steep, -steep]


def test_each_drive_has_a_grasp_at_its_angle_or_says_what_blocks_it() -> None:
    with bench(BLOCKED) as made:
        found = made.drives(*WIDE_FAN)
    by_angle = {round(math.degrees(drive.angle)): drive for drive in found}
    assert isinstance(by_angle[0].grasp, Infeasible)
    assert by_angle[0].grasp.blockers == ("o0",)
    assert (by_angle[0].blocking, by_angle[0].by_wall) == (1, False)
    for degrees in (15, -15, 30, -30):
        grasp = by_angle[degrees].grasp
        assert isinstance(grasp, Grasp)
        turned = abs(grasp.action.path.poses[0, 2] - math.radians(degrees))
        assert turned <= made.pushing.options.max_grasp_turn + 1e-9
    for degrees in (45, -45):
        assert (by_angle[degrees].blocking, by_angle[degrees].by_wall) == (0, True)


def test_what_blocks_the_grasp_counts_although_it_is_beside_the_corridor() -> None:
    beside = scene_of((0.45, 0.3), (0.45, 0.3605), (0.45, 0.2395))
    with bench(beside, half_width=0.05) as made:
        [drive] = made.drives(0.0)
        assert isinstance(drive.grasp, Infeasible)
        assert set(drive.grasp.blockers) == set(drive.problem.blockers)
        assert {beside.ids[row] for row in drive.problem.members} >= set(drive.grasp.blockers)
        assert not drive.by_wall


def mirror_of(made: Bench) -> dict[int, tuple[bool, bool]]:
    """By angle whether the target can be grasped, and whether a wall is what blocks that."""
    return {
        round(math.degrees(drive.angle)): (isinstance(drive.grasp, Grasp), drive.by_wall)
        for drive in made.drives(*WIDE_FAN)
    }


@often
@given(st.lists(st.sampled_from([(0.1, 0.2), (0.15, 0.38), (0.3, 0.19), (0.25, 0.3), (0.33, 0.44)]), unique=True))
def test_drives_in_a_mirrored_scene_are_mirrored(obstacles: list[tuple[float, float]]) -> None:
    scene = scene_of((0.45, 0.31), *obstacles)
    with bench(scene) as made, bench(mirrored(scene)) as other:
        ours, theirs = mirror_of(made), mirror_of(other)
    assert {-angle: drive for angle, drive in ours.items()} == theirs


def test_a_target_that_lies_or_is_not_to_be_retrieved_has_no_drive() -> None:
    with bench(BLOCKED) as made:
        start = made.task.start
        lying = replace(start, conditions=(Condition.TOPPLED, *start.conditions[1:]))
        found = drives(made.pushing, lying, WIDE_FAN)
    assert isinstance(found, Infeasible)
    assert "toppled" in found.reason


def test_what_is_no_longer_on_the_board_blocks_nothing() -> None:
    with bench(BLOCKED) as made:
        start = made.task.start
        gone = replace(start, conditions=(start.conditions[0], Condition.SPILLED))
        found = drives(made.pushing, gone, (0.0,))
    assert isinstance(found, list)
    assert found[0].blocking == 0
    assert isinstance(found[0].grasp, Grasp)
