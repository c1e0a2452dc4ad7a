"""The distances that every engine is given, so that all of them find the same diagram, bit by bit."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from phframe.core.errors import InputError
from phframe.core.value import FloatArray, IntArray


def pairwise_distances(points: FloatArray) -> NDArray[np.float32]:
    """The distances between points ``(n, 2)``, in metres: ``(n (n - 1) / 2,)``, the upper triangle row by row.

    They are float32, since Ripser knows nothing finer; rounding keeps their order, so a death found among them is the
    exact one, rounded.

    Raises:
        InputError: If the points are not ``(n, 2)``, not finite, or too far apart for float32.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2:
        raise InputError(f"points must have the shape (n, 2), not {points.shape}")
    first, second = _pairs(len(points))
    step = points[first] - points[second]
    with np.errstate(over="ignore", invalid="ignore"):
        distances = np.hypot(step[:, 0], step[:, 1]).astype(np.float32)
    if not (np.isfinite(distances).all() and np.isfinite(points).all()):
        raise InputError("points must be finite numbers, and less than 3e38 m apart")
    return distances


@lru_cache(maxsize=64)
def _pairs(n: int) -> tuple[IntArray, IntArray]:
    """Indices of the upper triangle; remembered, as finding them takes as long as the diagram itself."""
    first, second = np.triu_indices(n, 1)
    first.setflags(write=False)
    second.setflags(write=False)
    return first, second
