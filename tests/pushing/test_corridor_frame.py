"""Corridors: there and back between frames, and what lies in them."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from phframe.pushing import Corridor, Rectangle, Sweep

number = st.floats(-1.0, 1.0)


@st.composite
def corridors(draw: st.DrawFn) -> Corridor:
    origin = np.array([0.0, draw(st.floats(0.0, 1.0))])
    return Corridor(origin, draw(st.floats(-1.2, 1.2)), draw(number), 0.12, 0.0, draw(st.floats(0.1, 1.0)))


@given(corridors(), st.lists(st.tuples(number, number), min_size=1, max_size=5))
def test_points_come_back_from_the_corridor_frame(corridor: Corridor, points: list[tuple[float, float]]) -> None:
    array = np.array(points)
    np.testing.assert_allclose(corridor.to_shelf(corridor.to_local(array)), array, atol=1e-12)
    np.testing.assert_allclose(corridor.to_local(corridor.to_shelf(array)), array, atol=1e-12)


@given(corridors(), st.tuples(number, number), st.tuples(number, number))
def test_the_corridor_frame_keeps_distances(
    corridor: Corridor, first: tuple[float, float], second: tuple[float, float]
) -> None:
    a, b = corridor.to_local(np.array([first, second]))
    assert math.isclose(float(np.linalg.norm(a - b)), math.dist(first, second), abs_tol=1e-12)


@given(corridors(), st.floats(0.01, 0.99), st.floats(-0.9, 0.9))
def test_what_lies_on_the_strip_is_contained_and_what_lies_beside_it_is_not(
    corridor: Corridor, along: float, across: float
) -> None:
    x, y = along * corridor.end, corridor.axis + across * corridor.half_width
    inside = corridor.to_shelf(np.array([[x, y]]))
    beside = corridor.axis + (2.0 + across) * corridor.half_width
    outside = corridor.to_shelf(np.array([[x, beside], [x - corridor.end, y], [x + corridor.end, y]]))
    assert corridor.contains(inside).tolist() == [True]
    assert corridor.contains(outside).tolist() == [False] * 3


def test_the_edges_of_a_straight_corridor() -> None:
    corridor = Corridor(np.zeros(2), 0.0, 0.25, 0.125, 0.0, 0.5)
    points = np.array([[0.0, 0.25], [0.5, 0.25], [0.2, 0.375], [0.2, 0.376], [0.2, 0.125], [-0.001, 0.25]])
    assert corridor.contains(points).tolist() == [True, False, True, False, True, False]
    assert corridor.contains(np.empty((0, 2))).shape == (0,)


def test_a_positive_angle_points_to_the_north() -> None:
    corridor = Corridor(np.zeros(2), math.pi / 6.0, 0.12, 0.12, 0.0, 0.5, "north")
    np.testing.assert_allclose(corridor.to_shelf(np.array([1.0, 0.0])), [math.cos(math.pi / 6.0), 0.5])


def test_rectangles_know_their_centre_and_corners() -> None:
    rectangle = Rectangle(np.array([0.1, 0.2]), np.array([0.3, 0.6]))
    np.testing.assert_allclose(rectangle.center, [0.2, 0.4])
    assert rectangle.corners.tolist() == [[0.1, 0.2], [0.3, 0.2], [0.3, 0.6], [0.1, 0.6]]


def test_sweeps_go_in_across_and_out() -> None:
    sweep = Sweep(1, depth=0.4, lane=0.1, end=0.3, entry=0.45, exit=0.5)
    np.testing.assert_allclose(sweep.waypoints, [[-0.05, 0.1], [0.4, 0.1], [0.4, 0.3], [-0.1, 0.3]], atol=1e-12)


def test_a_tilted_arm_goes_in_and_out_along_itself() -> None:
    before, inserted, swept, out = Sweep(-1, depth=0.4, lane=0.3, end=0.1, entry=0.5, exit=0.2, tilt=0.3).waypoints
    ahead = np.array([math.cos(0.3), math.sin(0.3)])
    np.testing.assert_allclose(inserted - before, 0.5 * ahead)
    np.testing.assert_allclose(swept - out, 0.2 * ahead)
    np.testing.assert_allclose(swept - inserted, [0.0, -0.2])
