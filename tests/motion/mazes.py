"""Configuration spaces whose answers are known: a box with walls across it, each with a gap."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from phframe.core import FloatArray

Valid = Callable[[FloatArray], bool]

THICK = 0.1
"""Of the walls, to either side of their middle."""


def walls(*gaps: tuple[float, float]) -> Valid:
    """Walls across the first joint at 1, 2, ..., each open where the second joint is between two values."""
    borders = list(enumerate(gaps, start=1))

    def valid(q: FloatArray) -> bool:
        x, y = float(q[0]), float(q[1])
        return all(abs(x - at) > THICK or low < y < high for at, (low, high) in borders)

    return valid


def limits(dof: int, gaps: int) -> tuple[FloatArray, FloatArray]:
    """Room for some walls along the first joint, and 2 to either side for all others."""
    lower, upper = np.full(dof, -2.0), np.full(dof, 2.0)
    lower[0], upper[0] = 0.0, gaps + 1.0
    return lower, upper


def looked_at(a: FloatArray, b: FloatArray, resolution: float) -> FloatArray:
    """Configurations ``(k, dof)`` from a to b, ends included, no joint moving more than the resolution in between."""
    steps = max(1, int(np.ceil(np.abs(b - a).max() / resolution - 1e-9)))
    return np.asarray(a + np.linspace(0.0, 1.0, steps + 1)[:, None] * (b - a))


def length(path: FloatArray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
