"""Filled shapes for 2D views, which draw none: lines thick enough to fill a convex polygon."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray

OVERLAP = 0.9
"""Distance between lines in parts of their thickness, so that no seams are seen."""


def filling(vertices: FloatArray, lines: int) -> tuple[list[FloatArray], float]:
    """Fill a convex polygon.

    Lines have round ends; one along the edge, just inside, makes the edge straight, and the rest end on that one.

    Args:
        vertices: ``(k, 2)`` counter-clockwise (m).
        lines: About how many lines side by side.

    Returns:
        The lines, each ``(j, 2)`` (m), and half their thickness (m).
    """
    extent = np.ptp(vertices, axis=0)
    if not extent.all():
        return [], 0.0
    half = float(extent.min()) / (2 * lines)
    inner = _inset(vertices, half)
    across = int(np.argmin(extent))
    middles = np.arange(inner[:, across].min(), inner[:, across].max(), 2 * half * OVERLAP)[1:]
    return [np.vstack([inner, inner[:1]]), *(_chord(inner, across, float(at)) for at in middles)], half


def _inset(vertices: FloatArray, distance: float) -> FloatArray:
    """The polygon with every edge moved inwards: each corner is where two moved edges meet."""
    along = np.roll(vertices, -1, axis=0) - vertices
    inward = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    previous = np.roll(inward, 1, axis=0)
    both = np.stack([previous, inward], axis=1)  # a corner lies on the edge before it and on the edge after it
    offsets = (both * vertices[:, None, :]).sum(axis=2) + distance
    return np.linalg.solve(both, offsets[..., None])[..., 0]


def _chord(vertices: FloatArray, across: int, at: float) -> FloatArray:
    """The line ``(2, 2)`` that a convex polygon cuts out where coordinate ``across`` is ``at``."""
    ends = np.roll(vertices, -1, axis=0)
    crossed = (vertices[:, across] < at) != (ends[:, across] < at)
    a, b = vertices[crossed], ends[crossed]
    part = (at - a[:, across]) / (b[:, across] - a[:, across])
    return np.asarray(a + part[:, None] * (b - a))
