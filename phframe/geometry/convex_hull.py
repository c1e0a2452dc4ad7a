"""Convex hulls of points in the plane."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray

DECIMALS = 9
"""Of coordinates (m): points that differ by less are one."""


def convex_hull(points: FloatArray) -> FloatArray:
    """Corners ``(k, 2)`` of the convex hull of points ``(n, 2)``, counter-clockwise.

    Andrew's monotone chain (1979): both ways along the points sorted by x, dropping whatever does not turn left.
    """
    ordered = np.unique(np.round(points, DECIMALS), axis=0)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array([*lower[:-1], *upper[:-1]])


def _chain(points: FloatArray) -> list[FloatArray]:
    chain: list[FloatArray] = []
    for point in points:
        while len(chain) > 1 and _turns_right(chain[-2], chain[-1], point):
            chain.pop()
        chain.append(point)
    return chain


def _turns_right(a: FloatArray, b: FloatArray, c: FloatArray) -> bool:
    return bool((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 1e-12)
