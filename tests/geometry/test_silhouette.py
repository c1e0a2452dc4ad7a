"""How far a tilted arm stands out, against the bounds that its edges set one by one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import Outline
from phframe.geometry.parts import stacked
from phframe.geometry.silhouette import Silhouette
from tests.pushing.parts import ARM, boundary, highest, often, posed

tilts = st.one_of(st.just(0.0), st.floats(0.02, 1.2), st.floats(-1.2, -0.02))
TRIANGLE = Outline("triangle", np.array([[-0.1, -0.02], [0.0, 0.0], [-0.1, 0.05]]))


@often
@given(tilts)
def test_the_front_is_the_foremost_point(tilt: float) -> None:
    front = Silhouette(stacked(ARM.closed), tilt).front
    assert front == pytest.approx(posed(boundary(ARM.closed), 0, 0, tilt)[:, 0].max(), abs=1e-12)


@pytest.mark.parametrize("outlines", [ARM.closed, ARM.outlines(0.08), (TRIANGLE,)], ids=["closed", "open", "triangle"])
@often
@given(data=st.data(), tilt=tilts)
def test_the_side_at_a_depth(outlines: tuple[Outline, ...], data: st.DataObject, tilt: float) -> None:
    silhouette = Silhouette(stacked(outlines), tilt)
    depths = np.array(data.draw(st.lists(st.floats(-0.6, 0.2), min_size=1, max_size=5)))
    corners = np.concatenate([posed(outline.vertices, 0, 0, tilt) for outline in outlines])
    foremost = corners[corners[:, 0] >= silhouette.front - 1e-12, 1]
    for direction in (1, -1):
        for depth, side in zip(depths, silhouette.side(depths, direction), strict=True):
            if depth >= silhouette.front:  # what its front reaches: the corners there, however steep the edges behind
                assert side == pytest.approx((direction * foremost).max(), abs=1e-6)
            elif np.abs(corners[:, 0] - depth).min() >= 1e-8:  # not on a corner, where the widest may begin or end
                assert side == pytest.approx(highest(outlines, tilt, depth, direction), abs=1e-6)


def test_at_a_depth_where_a_wider_part_begins_it_counts() -> None:
    palm, link = (outline.vertices[:, 0].max() for outline in ARM.closed[2:])
    depths = np.array([0.1, 0.0, palm + 1e-9, palm, link + 1e-9, link, -0.5, -2.0])
    sides = Silhouette(stacked(ARM.closed), 0.0).side(depths, 1)
    np.testing.assert_allclose(sides, [0.009, 0.009, 0.009, 0.049, 0.049, 0.06, 0.06, -np.inf])


@often
@given(tilts, st.floats(-0.5, 0.1), st.floats(0.0, 0.3))
def test_the_widest_side_between_two_depths(tilt: float, nearest: float, extent: float) -> None:
    silhouette = Silhouette(stacked(ARM.closed), tilt)
    depths = np.linspace(nearest, nearest + extent, 400)
    corners = np.concatenate([posed(outline.vertices, 0, 0, tilt)[:, 0] for outline in ARM.closed])
    corners = corners[(corners > nearest) & (corners < nearest + extent)]
    for direction in (1, -1):
        widest = silhouette.widest_side(nearest, nearest + extent, direction)
        sampled = silhouette.side(np.concatenate([depths, corners]), direction)
        assert widest == pytest.approx(sampled.max(), abs=1e-9)


@often
@given(tilts, st.floats(-0.4, 0.1))
def test_north_and_south_are_mirror_images(tilt: float, depth: float) -> None:
    depths = np.array([depth])
    one, other = (Silhouette(stacked(ARM.closed), sign * tilt) for sign in (1, -1))
    assert one.side(depths, 1) == pytest.approx(other.side(depths, -1), abs=1e-12)


@pytest.mark.parametrize("outlines", [ARM.closed, ARM.outlines(0.08), (*ARM.closed, TRIANGLE)])
@often
@given(
    ways=st.lists(st.tuples(tilts, st.sampled_from([1, -1]), st.floats(-0.5, 0.1)), min_size=1),
    depths=st.lists(st.floats(-0.5, 0.2), min_size=1, max_size=3),
)
def test_several_tilts_at_once_are_as_each_by_itself(
    outlines: tuple[Outline, ...], ways: list[tuple[float, int, float]], depths: list[float]
) -> None:
    parts = stacked(outlines)
    many = Silhouette(parts, tuple(tilt for tilt, *_ in ways))
    directions, nearest = np.array([way for _, way, _ in ways]), np.array([depth for *_, depth in ways])
    sides = many.side(np.array(depths)[:, None] + nearest, directions)
    widest = many.widest_side(nearest, nearest + 0.1, directions)
    for row, (tilt, direction, depth) in enumerate(ways):
        one = Silhouette(parts, tilt)
        assert many.front[row] == one.front
        assert (many.lowest[row], many.highest[row]) == (one.lowest, one.highest)
        np.testing.assert_array_equal(sides[:, row], one.side(np.array(depths) + depth, direction))
        assert widest[row] == one.widest_side(depth, depth + 0.1, direction)
        at_tip = {1: one.tip_sides[0], -1: one.tip_sides[1]}[direction]
        assert at_tip == one.side(np.zeros(1), direction)[0]
