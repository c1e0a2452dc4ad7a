"""What an arm sweeps over as it moves straight on, against convex hulls of where it begins and ends."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import FloatArray, Outline, rotation_matrix
from phframe.geometry.convex_hull import convex_hull
from phframe.geometry.parts import stacked, turned
from phframe.geometry.polygon import signed_distance
from phframe.geometry.straight_motion import distances_on_way_in, swept_distances
from tests.pushing.parts import ARM, often

WEDGE = Outline("wedge", np.array([[-0.1, -0.02], [0.0, 0.0], [-0.1, 0.05]]))
SHAPES = {"closed": ARM.closed, "open": ARM.outlines(0.08), "mixed": (*ARM.closed[:3], WEDGE)}
millimetres = st.integers(-400, 400).map(lambda number: number / 1000.0)
places = st.tuples(millimetres, millimetres)
angles = st.integers(-12, 12).map(lambda tenths: tenths / 10.0)
ways = st.lists(st.tuples(angles, places), min_size=1, max_size=4)


def hulls(outlines: tuple[Outline, ...], angle: float, motion: FloatArray) -> list[FloatArray]:
    corners = [outline.vertices @ rotation_matrix(angle).T for outline in outlines]
    return [convex_hull(np.concatenate([part, part + motion])) for part in corners]


@pytest.mark.parametrize("shape", SHAPES)
@often
@given(ways=ways, points=st.lists(places, min_size=1, max_size=4))
def test_distances_from_what_is_swept_over_are_those_from_the_hulls(
    shape: str, ways: list[tuple[float, tuple[float, float]]], points: list[tuple[float, float]]
) -> None:
    outlines, motions = SHAPES[shape], np.array([motion for _, motion in ways])
    parts = turned(stacked(outlines), tuple(angle for angle, _ in ways))
    found = swept_distances(parts, motions, np.array(points))
    assert found.shape == (len(points), len(ways))
    for way, (angle, motion) in enumerate(ways):
        regions = hulls(outlines, angle, np.array(motion))
        for row, point in enumerate(points):
            nearest = min(signed_distance(region, np.array(point)) for region in regions)
            assert found[row, way] == pytest.approx(max(nearest, 0.0), abs=2e-8)


@often
@given(points=st.lists(places, min_size=1, max_size=4), lengths=st.lists(st.floats(0.0, 0.6), min_size=1, max_size=3))
def test_on_a_way_in_the_arm_sweeps_over_its_boxes_drawn_back(
    points: list[tuple[float, float]], lengths: list[float]
) -> None:
    parts = stacked(ARM.closed)
    boxes = parts.min(axis=1), parts.max(axis=1)
    found = distances_on_way_in(np.array(points), *boxes, np.array(lengths))
    assert found.shape == (len(lengths), len(parts), len(points))
    for each, length in zip(found, lengths, strict=True):
        swept = [convex_hull(np.concatenate([part, part - [length, 0.0]])) for part in parts]
        expected = [[max(signed_distance(part, np.array(point)), 0.0) for point in points] for part in swept]
        np.testing.assert_allclose(each, expected, atol=2e-8)
