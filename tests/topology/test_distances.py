from __future__ import annotations

import numpy as np
import pytest

from phframe.core import InputError
from phframe.topology.distances import pairwise_distances


def test_they_are_the_upper_triangle_row_by_row_as_float32() -> None:
    distances = pairwise_distances(np.array([[0.0, 0.0], [0.3, 0.4], [0.3, 0.0]]))
    np.testing.assert_array_equal(distances, np.array([0.5, 0.3, 0.4], dtype=np.float32))
    assert distances.dtype == np.float32


@pytest.mark.parametrize(
    "points", [np.zeros(2), np.zeros((2, 1)), np.zeros((2, 3)), np.zeros((2, 2, 2))], ids=lambda p: str(p.shape)
)
def test_a_wrong_shape_is_refused(points: np.ndarray) -> None:
    with pytest.raises(InputError, match=r"must have the shape \(n, 2\)"):
        pairwise_distances(points)


@pytest.mark.parametrize("points", [[[np.nan, 0.0]], [[np.inf, 0.0], [0.0, 0.0]], [[0.0, 0.0], [1e39, 0.0]]], ids=str)
def test_numbers_that_are_not_distances_are_refused(points: list[list[float]]) -> None:
    with pytest.raises(InputError, match="points must be finite numbers"):
        pairwise_distances(np.array(points))
