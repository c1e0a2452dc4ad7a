"""Which way is pushed: the paper's rule, and what happens where it does not fit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from phframe.core import Shelf
from phframe.geometry.arm_view import ArmView
from phframe.pushing import Corridor, Deviation, PushingOptions
from phframe.pushing.sweep_generator import SweepGenerator
from phframe.pushing.tilted_sweep import Push
from tests.pushing.parts import ARM, HALF_WIDTH, RADIUS, often
from tests.pushing.sweep_cases import Case, cases, millimetres

TARGET = (0.45, 0.3)
WIDE = Shelf(0.6, 0.6)
OTHER = {Deviation.OTHER_DIRECTION, Deviation.SPANS_CORRIDOR}


def first(case: Case) -> Push:
    return case.pushes[0]


@often
@given(cases())
def test_towards_the_side_of_the_centre_line_on_which_the_rectangle_lies(case: Case) -> None:
    """Where a sweep goes the other way, it says so."""
    middle = (case.local[:, 1].min() + case.local[:, 1].max()) / 2.0 - case.corridor.axis
    if abs(middle) < 1e-9:
        return
    for push in case.pushes:
        follows = push.sweep.direction == (1 if middle > 0.0 else -1)
        assert bool(OTHER & {*push.deviations}) is not follows


@pytest.mark.parametrize(("y", "direction"), [(0.31, 1), (0.29, -1), (0.2, -1), (0.4, 1)])
def test_north_of_the_line_goes_north_and_south_of_it_south(y: float, direction: int) -> None:
    push = first(Case(WIDE, TARGET, np.array([[0.2, y]])))
    assert (push.sweep.direction, push.deviations) == (direction, ())


@pytest.mark.parametrize(("width", "direction"), [(0.6, -1), (0.625, -1), (0.575, 1)])
def test_on_the_line_the_middle_of_the_shelf_decides(width: float, direction: int) -> None:
    """``c_R <= c_W``: top to bottom, that is south; else north."""
    push = first(Case(Shelf(0.6, width), TARGET, np.array([[0.2, 0.25], [0.2, 0.35]])))
    assert (push.sweep.direction, push.deviations) == (direction, ())


@pytest.mark.parametrize(("depth", "direction"), [(1.0, -1), (1.2, 1)])
def test_in_an_angled_corridor_the_middle_of_the_shelf_is_where_it_is_in_its_frame(
    depth: float, direction: int
) -> None:
    """At 0.3 rad the middle of a shelf 0.6 m wide is at y = 0.3 cos 0.3 - depth/2 sin 0.3 there: 0.139 or 0.109 m."""
    shelf = Shelf(depth, 0.6)
    corridor = Corridor(np.zeros(2), 0.3, 0.12, HALF_WIDTH, 0.0, 0.5, "north")
    for mirror in (1, -1):
        if mirror == -1:
            corridor = Corridor(np.array([0.0, 0.6]), -0.3, -0.12, HALF_WIDTH, 0.0, 0.5, "south")
        members = np.array([[0.3, corridor.axis]])
        view = ArmView(shelf, ARM.closed, 0.002)
        pushes = [*SweepGenerator(corridor, members, RADIUS, RADIUS, view, PushingOptions()).pushes()]
        assert {push.sweep.direction for push in pushes if not OTHER & {*push.deviations}} == {mirror * direction}


def spanning(y: float, *more: tuple[float, float]) -> Case:
    """A rectangle that reaches from edge to edge of a corridor that is at the south wall but for 2 cm."""
    members = np.array([(0.2, y - 0.095), (0.2, y + 0.095), *more])
    case = Case(WIDE, (0.45, y), members)
    across = case.local[:, 1] - case.corridor.axis
    assert across.min() <= RADIUS - HALF_WIDTH
    assert across.max() >= HALF_WIDTH - RADIUS
    return case


def test_what_spans_the_corridor_goes_the_papers_way_where_that_clears() -> None:
    for y, direction in ((0.3, -1), (0.28, -1), (0.32, 1)):
        push = first(spanning(y, (0.25, y + direction * 0.1)))
        assert (push.sweep.direction, OTHER & {*push.deviations}, push.clears) == (direction, set(), True)


def test_else_what_spans_the_corridor_is_swept_from_the_nearer_wall() -> None:
    """The paper's way is south, where there is no room between corridor and wall."""
    case = spanning(0.14, (0.25, 0.04))
    push = first(case)
    assert (push.sweep.direction, push.clears) == (1, True)
    assert Deviation.SPANS_CORRIDOR in push.deviations
    narrower = Case(WIDE, (0.45, 0.14), np.array([[0.2, 0.06], [0.2, 0.21]]))
    assert OTHER & {*first(narrower).deviations} == {Deviation.OTHER_DIRECTION}


off_limits = st.integers(70, 110).map(lambda number: number / 1000.0 + 0.0005)
"""Distances from the centre line, none of them where a rectangle just spans the corridor."""


@often
@given(millimetres(0.15, 0.45), off_limits, off_limits, st.tuples(millimetres(0.05, 0.4), millimetres(0.05, 0.4)))
def test_the_other_direction_is_said_to_be_from_the_nearer_wall_where_it_is_and_the_corridor_is_spanned(
    y: float, south: float, north: float, depths: tuple[float, float]
) -> None:
    """Spanned: on either side there is no room for one more radius in the corridor."""
    assume(y - south >= RADIUS and y + north <= WIDE.width - RADIUS and abs(south - north) > 1e-9)
    case = Case(WIDE, (0.5, y), np.array([[depths[0], y - south], [depths[1], y + north]]))
    center = y + (north - south) / 2.0
    assume(abs(center - WIDE.width / 2.0) > 1e-9)
    other, from_nearer = -1 if north > south else 1, 1 if center < WIDE.width / 2.0 else -1
    spans = min(south, north) > HALF_WIDTH - RADIUS
    name = Deviation.SPANS_CORRIDOR if spans and other == from_nearer else Deviation.OTHER_DIRECTION
    for push in case.pushes:
        assert OTHER & {*push.deviations} == ({name} if push.sweep.direction == other else set())


@pytest.mark.parametrize(
    ("y", "south", "north", "other", "name"),
    [
        (0.4, 0.0955, 0.1005, -1, Deviation.SPANS_CORRIDOR),
        (0.2, 0.0955, 0.1005, -1, Deviation.OTHER_DIRECTION),
        (0.2, 0.1005, 0.0955, 1, Deviation.SPANS_CORRIDOR),
        (0.4, 0.1005, 0.0955, 1, Deviation.OTHER_DIRECTION),
    ],
)
def test_the_nearer_wall_is_the_one_of_the_half_that_the_rectangle_is_in(
    y: float, south: float, north: float, other: int, name: Deviation
) -> None:
    pushes = Case(WIDE, (0.5, y), np.array([[0.2, y - south], [0.3, y + north]])).pushes
    assert {push.sweep.direction for push in pushes} == {1, -1}
    for push in pushes:
        assert OTHER & {*push.deviations} == ({name} if push.sweep.direction == other else set())


def test_where_there_is_no_room_at_the_wall_the_other_direction_is_taken() -> None:
    """The corridor ends 2 cm from the wall: nothing fits between the two."""
    case = Case(Shelf(0.6, 0.6), (0.45, 0.14), np.array([[0.2, 0.12]]))
    push = first(case)
    assert (push.sweep.direction, push.clears) == (1, True)
    assert push.deviations[0] == Deviation.OTHER_DIRECTION
    last = case.pushes[-1]
    assert (last.sweep.direction, last.clears) == (-1, False)
    assert last.deviations[-1] == Deviation.NOT_CLEARING


def test_where_neither_direction_clears_the_papers_comes_first() -> None:
    for y, direction in ((0.12, -1), (0.13, 1)):
        pushes = Case(Shelf(0.6, 0.25), (0.45, 0.125), np.array([[0.2, y]])).pushes
        assert [push.sweep.direction for push in pushes] == [direction, -direction]
        assert not any(push.clears for push in pushes)


def test_where_the_arm_does_not_fit_nothing_is_proposed() -> None:
    for width, fits in ((0.12, False), (0.25, True)):
        corridor = Corridor(np.zeros(2), 0.0, width / 2, 0.05, 0.0, 0.4)
        view = ArmView(Shelf(0.6, width), ARM.closed, 0.002)
        pushes = SweepGenerator(corridor, np.array([[0.2, width / 2]]), RADIUS, RADIUS, view, PushingOptions()).pushes()
        assert bool(list(pushes)) is fits
