"""How far an arm can move before it meets a wall, against distances worked out corner by corner."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from phframe.core import FloatArray, Outline
from phframe.geometry.parts import stacked
from phframe.geometry.wall_clearance import WallClearance
from tests.pushing.parts import ARM, SHELF, gap_to_walls, often

yaws = st.integers(-120, 120).map(lambda hundredths: hundredths / 100.0)
headings = st.integers(0, 71).map(lambda steps: steps * math.pi / 36.0)
WEDGE = Outline("wedge", np.array([[-0.1, -0.02], [0.0, 0.0], [-0.1, 0.05]]))
SHAPES = {"closed": ARM.closed, "open": ARM.outlines(0.08), "mixed": (*ARM.closed[:3], WEDGE)}


@st.composite
def free_starts(draw: st.DrawFn, outlines: tuple[Outline, ...], margin: float) -> tuple[FloatArray, float]:
    """A fingertip position and a yaw at which the arm keeps a little more than the margin from the walls."""
    yaw, x, y = draw(yaws), draw(st.floats(-0.2, SHELF.depth)), draw(st.floats(0.0, SHELF.width))
    assume(gap(outlines, np.array([x, y]), yaw) > margin + 1e-6)
    return np.array([x, y]), yaw


def gap(outlines: tuple[Outline, ...], tip: FloatArray, yaw: float) -> float:
    return gap_to_walls(outlines, np.array([*tip, yaw]))


def keeps_its_promise(
    outlines: tuple[Outline, ...], tip: FloatArray, yaw: float, heading: float, distance: float, margin: float
) -> None:
    ahead = np.array([math.cos(heading), math.sin(heading)])
    travel = WallClearance(SHELF, stacked(outlines), yaw, margin).travel(tip, ahead, distance)
    assert 0.0 <= travel <= distance
    for fraction in np.linspace(0.0, 1.0, 12):
        assert gap(outlines, tip + fraction * travel * ahead, yaw) >= margin - 1e-6
    if travel < distance and margin < 1e-6:
        assert gap(outlines, tip + travel * ahead, yaw) < 1e-6, "it stops although nothing is near"


@pytest.mark.parametrize("shape", SHAPES)
@often
@given(
    data=st.data(), heading=headings, distance=st.floats(0.0, 0.8), margin=st.sampled_from([1e-9, 1e-9, 0.002, 0.01])
)
def test_the_arm_moves_until_the_margin_is_used_up_and_no_farther(
    shape: str, data: st.DataObject, heading: float, distance: float, margin: float
) -> None:
    outlines = SHAPES[shape]
    tip, yaw = data.draw(free_starts(outlines, margin))
    keeps_its_promise(outlines, tip, yaw, heading, distance, margin)


@pytest.mark.parametrize("corners", [3, 6])
def test_parts_may_have_any_number_of_corners(corners: int) -> None:
    angles = np.linspace(0.0, 2.0 * math.pi, corners, endpoint=False)
    round_part = Outline("round", 0.04 * np.column_stack([np.cos(angles) - 1.0, np.sin(angles)]))
    keeps_its_promise((round_part,), np.array([0.2, 0.3]), 0.3, 0.5, 0.8, 1e-9)


@often
@given(yaws, st.floats(-0.3, 0.7), st.floats(-0.1, 0.7))
def test_free_is_where_the_arm_is_in_no_wall(yaw: float, x: float, y: float) -> None:
    between = gap(ARM.closed, np.array([x, y]), yaw)
    assume(abs(between) > 1e-6)
    assert WallClearance(SHELF, stacked(ARM.closed), yaw, 1e-9).is_free(np.array([x, y])) == (between > 0.0)


def test_a_straight_arm_stops_at_the_margin_from_each_wall() -> None:
    walls, tip = WallClearance(SHELF, stacked(ARM.closed), 0.0, 0.002), np.array([0.3, 0.3])
    ways = {(1.0, 0.0): 0.298, (0.0, 1.0): 0.3 - 0.06 - 0.002, (0.0, -1.0): 0.3 - 0.06 - 0.002, (-1.0, 0.0): 1.0}
    for way, room in ways.items():
        assert walls.travel(tip, np.array(way), 1.0) == pytest.approx(room)


def test_along_a_wall_the_way_is_free_and_from_within_one_it_is_not() -> None:
    walls = WallClearance(SHELF, stacked(ARM.closed), 0.0, 0.002)
    assert walls.travel(np.array([0.0, 0.0621]), np.array([1.0, 0.0]), 0.5) == 0.5
    assert walls.travel(np.array([0.2, 0.05]), np.array([1.0, 0.0]), 0.5) == 0.0
    assert not walls.is_free(np.array([0.2, 0.05]))


def test_beside_the_mouth_there_is_a_wall_and_before_it_there_is_none() -> None:
    walls = WallClearance(SHELF, stacked(ARM.closed), 0.0, 0.0)
    assert walls.travel(np.array([-0.2, -0.1]), np.array([1.0, 0.0]), 1.0) == pytest.approx(0.2)
    assert walls.travel(np.array([-0.2, -0.1]), np.array([0.0, -1.0]), 1.0) == 1.0


def test_parts_with_fewer_corners_than_others_meet_walls_without_a_margin_too() -> None:
    bar = Outline("bar", np.array([[-0.1, -0.01], [-0.09, -0.01], [-0.09, 0.01], [-0.1, 0.01]]))
    walls = WallClearance(SHELF, stacked((WEDGE, bar)), 0.0, 0.0)
    assert walls.travel(np.array([0.2, 0.3]), np.array([1.0, 0.0]), 1.0) == pytest.approx(0.4)
    assert not walls.is_free(np.array([0.61, 0.3]))


def test_a_yaw_that_is_nearly_nothing_is_none() -> None:
    tip, ahead = np.array([-0.05, 0.4]), np.array([1.0, 0.0])
    tiny, none = (
        WallClearance(SHELF, stacked(ARM.closed), yaw, 0.002).travel(tip, ahead, 0.5) for yaw in (2e-311, 0.0)
    )
    assert tiny == pytest.approx(none)


@pytest.mark.parametrize("shape", SHAPES)
@often
@given(
    reaches=st.lists(
        st.tuples(yaws, st.floats(0.0, 0.6), st.floats(0.0, 0.6), headings, st.floats(0.0, 0.8)), min_size=1
    )
)
def test_several_yaws_at_once_are_as_each_by_itself(
    shape: str, reaches: list[tuple[float, float, float, float, float]]
) -> None:
    parts = stacked(SHAPES[shape])
    many = WallClearance(SHELF, parts, tuple(yaw for yaw, *_ in reaches), 0.002)
    tips, ways = np.array([[x, y] for _, x, y, *_ in reaches]), np.array([_along(way) for *_, way, _ in reaches])
    lengths = np.array([length for *_, length in reaches])
    ahead, back = many.room(tips, ways, lengths)
    free, out = many.is_free(tips), many.lets_out(tips, lengths)
    for row, (yaw, *_, length) in enumerate(reaches):
        one = WallClearance(SHELF, parts, yaw, 0.002)
        assert ahead[row] == pytest.approx(one.travel(tips[row], ways[row], length))
        assert back[row] == pytest.approx(one.travel(tips[row], -ways[row], length))
        assert free[row] == one.is_free(tips[row])
        start = tips[row] - length * _along(yaw)
        blocked = one.travel(tips[row], -_along(yaw), length), one.travel(start, _along(yaw), length)
        if length > 0.0:
            assert [bool(each >= length) for each in blocked] == [out[row]] * 2


def _along(heading: float) -> FloatArray:
    return np.array([math.cos(heading), math.sin(heading)])
