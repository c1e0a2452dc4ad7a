"""The path region is where the paper's definition puts it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from phframe.core import Cylinder, FloatArray, Infeasible, Shelf
from phframe.pushing.corridor import Corridor, corridor_half_width, find_corridor
from tests.pushing.parts import ARM, RADIUS, SHELF, in_strip, often, places, scene_of, shelves

widths = st.floats(0.05, 0.15)


def found(target: tuple[float, float], shelf: Shelf = SHELF, w: float = 0.12) -> Corridor:
    corridor = find_corridor(np.array(target), shelf, w)
    assert isinstance(corridor, Corridor), corridor
    return corridor


def distance_to_line(point: FloatArray, corridor: Corridor) -> float:
    """Of a point from the line through the mouth corner along the corridor; positive to its left."""
    x, y = point - corridor.origin
    return float(y * math.cos(corridor.angle) - x * math.sin(corridor.angle))


@often
@given(st.data(), shelves(), widths)
def test_in_a_shelf_wide_enough_every_target_has_a_corridor_that_ends_at_it(
    data: st.DataObject, shelf: Shelf, w: float
) -> None:
    target = data.draw(places(shelf))
    corridor = found(target, shelf, w)
    np.testing.assert_allclose(corridor.to_shelf(np.array([corridor.end, corridor.axis])), target, atol=1e-12)
    assert (corridor.half_width, corridor.start) == (w, 0.0)


@often
@given(st.data(), shelves(), widths)
def test_far_from_both_walls_the_corridor_is_straight(data: st.DataObject, shelf: Shelf, w: float) -> None:
    x, y = data.draw(places(shelf))
    corridor = found((x, y), shelf, w)
    straight = y >= w and shelf.width - y >= w
    assert (corridor.beside is None) is straight
    if straight:
        assert (corridor.angle, corridor.axis, corridor.end) == (0.0, y, x)


@often
@given(st.data(), shelves(), widths, st.floats(0.0, 0.99))
def test_near_a_wall_a_line_through_the_far_mouth_corner_passes_the_target_at_distance_w(
    data: st.DataObject, shelf: Shelf, w: float, fraction: float
) -> None:
    x = data.draw(st.floats(0.01, shelf.depth))
    north = found((x, shelf.width - fraction * w), shelf, w)
    assert (north.beside, north.origin.tolist()) == ("north", [0.0, 0.0])
    assert distance_to_line(np.array([x, shelf.width - fraction * w]), north) == pytest.approx(w)
    south = found((x, fraction * w), shelf, w)
    assert (south.beside, south.origin.tolist()) == ("south", [0.0, shelf.width])
    assert distance_to_line(np.array([x, fraction * w]), south) == pytest.approx(-w)


def test_the_angle_of_the_specification() -> None:
    x, y, w = 0.4, 0.55, 0.12
    assert found((x, y)).angle == pytest.approx(math.atan2(y, x) - math.asin(w / math.hypot(x, y)))


@often
@given(st.data(), shelves(), widths)
def test_north_and_south_are_mirror_images(data: st.DataObject, shelf: Shelf, w: float) -> None:
    x, y = data.draw(places(shelf))
    assume(min(abs(y - w), abs(shelf.width - y - w)) > 1e-9)  # where rounding decides
    points = np.array(data.draw(st.lists(places(shelf), min_size=1, max_size=8)))
    one, other = found((x, y), shelf, w), found((x, shelf.width - y), shelf, w)
    assert other.beside == {"north": "south", "south": "north", None: None}[one.beside]
    assert other.angle == pytest.approx(-one.angle)
    local, mirrored = one.to_local(points), other.to_local(points * [1, -1] + [0, shelf.width])
    np.testing.assert_allclose(mirrored[:, 0], local[:, 0], atol=1e-12)
    np.testing.assert_allclose(mirrored[:, 1] - other.axis, one.axis - local[:, 1], atol=1e-12)


@often
@given(st.data(), shelves(), widths)
def test_what_counts_is_what_the_definition_says(data: st.DataObject, shelf: Shelf, w: float) -> None:
    target = data.draw(places(shelf, 0.05))
    corridor = found(target, shelf, w)
    points = np.array(data.draw(st.lists(places(shelf, -0.1), min_size=1, max_size=20)))
    local = corridor.to_local(points)
    clear = np.abs(np.abs(local[:, 1] - corridor.axis) - w) > 1e-9
    clear &= (np.abs(local[:, 0]) > 1e-9) & (np.abs(local[:, 0] - corridor.end) > 1e-9)
    expected = in_strip(corridor, np.array(target), points)
    assert corridor.contains(points)[clear].tolist() == expected[clear].tolist()


def test_on_the_edge_counts_and_level_with_the_target_does_not() -> None:
    corridor = found((0.5, 0.25), w=0.125)
    on_edges = np.array([[0.0, 0.25], [0.2, 0.375], [0.2, 0.125]])
    assert corridor.contains(on_edges).all()
    beyond = np.array([[0.5, 0.25], [0.5, 0.3], [0.2, 0.375 + 1e-12], [0.2, 0.125 - 1e-12], [-1e-12, 0.25]])
    assert not corridor.contains(beyond).any()


@pytest.mark.parametrize(
    ("y", "beside"), [(0.125, None), (0.124, "south"), (0.475, None), (0.476, "north"), (0.3, None)]
)
def test_a_target_exactly_w_from_a_wall_is_far_enough(y: float, beside: str | None) -> None:
    assert found((0.4, y), Shelf(0.6, 0.6), 0.125).beside == beside


@pytest.mark.parametrize("y", [0.09, 0.1, 0.11])
def test_a_shelf_narrower_than_the_corridor_is_refused_with_what_to_do(y: float) -> None:
    refused = find_corridor(np.array([0.4, y]), Shelf(0.6, 0.2), 0.12)
    assert isinstance(refused, Infeasible)
    for part in ("0.2 m wide", "0.24 m", "half_width", "auto"):
        assert part in refused.reason
    assert found((0.4, 0.1), Shelf(0.6, 0.2), 0.1).beside is None


def test_the_half_width_is_what_is_set_or_what_arm_and_obstacles_need() -> None:
    scene = scene_of((0.4, 0.3), (0.2, 0.3), (0.2, 0.4))
    wide = replace(scene.objects[1], shape=Cylinder(0.04))
    assert corridor_half_width(0.11, scene, ARM) == 0.11
    assert corridor_half_width("auto", scene, ARM) == pytest.approx(0.12 / 2 + RADIUS + 0.004)
    assert corridor_half_width("auto", replace(scene, objects=(scene.objects[0], wide)), ARM) == pytest.approx(0.104)


def test_the_target_itself_does_not_widen_the_corridor() -> None:
    scene = scene_of((0.4, 0.3))
    fat = replace(scene.objects[0], shape=Cylinder(0.05))
    assert corridor_half_width("auto", replace(scene, objects=(fat,)), ARM) == pytest.approx(0.064)
