"""How far an arm can move before it meets a wall, against small steps of its boundary."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from phframe.core import FloatArray, Outline, Shelf
from phframe.pushing.clearance import WallClearance
from tests.pushing.parts import ARM, SHELF, boundary, distance_from_walls, posed

STEP = 0.004
yaws = st.one_of(st.just(0.0), st.floats(-1.2, 1.2))
headings = st.one_of(st.sampled_from([k * math.pi / 2 for k in range(4)]), st.floats(0.0, 2 * math.pi))
WEDGE = Outline("wedge", np.array([[-0.1, -0.02], [0.0, 0.0], [-0.1, 0.05]]))
SHAPES = {"closed": ARM.closed, "open": ARM.outlines(0.08), "wedge": (WEDGE,), "mixed": (*ARM.closed, WEDGE)}


@st.composite
def free_starts(draw: st.DrawFn, outlines: tuple[Outline, ...], margin: float) -> tuple[FloatArray, float]:
    """A fingertip position and a yaw at which the arm keeps a little more than the margin from the walls."""
    yaw, x, y = draw(yaws), draw(st.floats(-0.2, SHELF.depth)), draw(st.floats(0.0, SHELF.width))
    assume(gap(outlines, np.array([x, y]), yaw) > margin + 1e-6)
    return np.array([x, y]), yaw


def gap(outlines: tuple[Outline, ...], tip: FloatArray, yaw: float, shelf: Shelf = SHELF) -> float:
    """Between an arm and the nearest wall; negative where it is inside one."""
    return float(distance_from_walls(posed(boundary(outlines), *tip, yaw), shelf).min())


@pytest.mark.parametrize("shape", SHAPES)
@settings(max_examples=40)
@given(data=st.data(), heading=headings, distance=st.floats(0.0, 0.8), margin=st.sampled_from([1e-9, 0.002, 0.01]))
def test_the_arm_moves_up_to_the_margin_and_no_farther(
    shape: str, data: st.DataObject, heading: float, distance: float, margin: float
) -> None:
    outlines = SHAPES[shape]
    start, yaw = data.draw(free_starts(outlines, 1.5 * margin))
    ahead = np.array([math.cos(heading), math.sin(heading)])
    walls = WallClearance(SHELF, outlines, yaw, margin)
    travel = walls.travel(start, ahead, distance)
    assert 0.0 <= travel <= distance
    for share in np.linspace(0.0, 1.0, 8):
        assert gap(outlines, start + share * travel * ahead, yaw) >= min(margin, 1.0) - 1e-6
    if travel < distance and margin < 1e-6:
        assert gap(outlines, start + travel * ahead, yaw) < 1e-4
        assert not walls.is_free(start + (travel + 1e-5) * ahead) or gap(outlines, start + travel * ahead, yaw) < 1e-6


@pytest.mark.parametrize("shape", SHAPES)
@settings(max_examples=40)
@given(data=st.data(), heading=headings)
def test_small_steps_meet_the_wall_in_the_same_place(shape: str, data: st.DataObject, heading: float) -> None:
    outlines = SHAPES[shape]
    start, yaw = data.draw(free_starts(outlines, 1e-6))
    ahead = np.array([math.cos(heading), math.sin(heading)])
    travel = WallClearance(SHELF, outlines, yaw, 1e-9).travel(start, ahead, 0.5)
    steps = np.arange(0.0, 0.5, STEP)
    blocked = [s for s in steps if gap(outlines, start + s * ahead, yaw) < -1e-3]
    if blocked:
        assert travel <= blocked[0] + 1e-6
    for s in steps[steps < travel]:
        assert gap(outlines, start + s * ahead, yaw) > -1e-3


@settings(max_examples=60)
@given(yaws, st.floats(-0.3, 0.7), st.floats(-0.1, 0.7))
def test_free_is_where_the_arm_is_in_no_wall(yaw: float, x: float, y: float) -> None:
    between = gap(ARM.closed, np.array([x, y]), yaw)
    assume(abs(between) > 5e-3)
    assert WallClearance(SHELF, ARM.closed, yaw, 1e-9).is_free(np.array([x, y])) is (between > 0.0)


def test_a_straight_arm_stops_at_the_margin_from_each_wall() -> None:
    walls, tip = WallClearance(SHELF, ARM.closed, 0.0, 0.002), np.array([0.3, 0.3])
    ways = {(1.0, 0.0): 0.298, (0.0, 1.0): 0.3 - 0.06 - 0.002, (0.0, -1.0): 0.3 - 0.06 - 0.002, (-1.0, 0.0): 1.0}
    for way, room in ways.items():
        assert walls.travel(tip, np.array(way), 1.0) == pytest.approx(room)


def test_along_a_wall_the_way_is_free_and_from_within_one_it_is_not() -> None:
    walls = WallClearance(SHELF, ARM.closed, 0.0, 0.002)
    assert walls.travel(np.array([0.0, 0.0621]), np.array([1.0, 0.0]), 0.5) == 0.5
    assert walls.travel(np.array([0.2, 0.05]), np.array([1.0, 0.0]), 0.5) == 0.0
    assert not walls.is_free(np.array([0.2, 0.05]))


def test_beside_the_mouth_there_is_a_wall_and_before_it_there_is_none() -> None:
    walls = WallClearance(SHELF, ARM.closed, 0.0, 0.0)
    assert walls.travel(np.array([-0.2, -0.1]), np.array([1.0, 0.0]), 1.0) == pytest.approx(0.2)
    assert walls.travel(np.array([-0.2, -0.1]), np.array([0.0, -1.0]), 1.0) == 1.0


@pytest.mark.xfail(reason="an edge of no length counts as one that always bounds, where the margin is 0")
def test_parts_with_different_numbers_of_corners_meet_walls_without_a_margin_too() -> None:
    walls = WallClearance(SHELF, (*ARM.closed, WEDGE), 0.0, 0.0)
    assert not WallClearance(SHELF, (*ARM.closed, WEDGE), 0.0, 1e-9).is_free(np.array([0.3, 0.01]))
    alone = WallClearance(SHELF, (WEDGE,), 0.0, 0.0)
    assert not alone.is_free(np.array([0.62, 0.3]))
    padded = WallClearance(SHELF, (WEDGE, Outline("bar", ARM.closed[0].vertices * 1e-3)), 0.0, 0.0)
    assert not padded.is_free(np.array([0.05 + 0.6, 0.3]))
    assert walls.travel(np.array([0.0, 0.3]), np.array([1.0, 0.0]), 1.0) == pytest.approx(0.6)
