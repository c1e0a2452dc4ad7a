"""The convex parts of an arm as one array, turned by any number of angles at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import FloatArray, Outline, rotated_in_plane, rotation_matrix

Angles = float | tuple[float, ...]
"""One angle or several (rad). What is worked out for several has one leading axis more than what is for one."""


def stacked(outlines: Sequence[Outline]) -> FloatArray:
    """Corners ``(m, v, 2)``, the last of each part repeated up to the longest: an edge of no length bounds nothing (m)."""
    longest = max(len(outline.vertices) for outline in outlines)
    padded = [[*outline.vertices, *[outline.vertices[-1]] * (longest - len(outline.vertices))] for outline in outlines]
    return np.array(padded)


def turns(angles: Angles) -> FloatArray:
    """The matrices ``(..., 2, 2)`` that turn plane vectors by angles."""
    if isinstance(angles, tuple):
        return np.array([rotation_matrix(angle) for angle in angles])
    return rotation_matrix(angles)


def turned(parts: FloatArray, angles: Angles) -> FloatArray:
    """Parts ``(m, v, 2)`` turned about the origin by angles: ``(..., m, v, 2)``."""
    return rotated_in_plane(parts, np.swapaxes(turns(angles), -1, -2)[..., None, None, :, :])


def edges_of(parts: FloatArray) -> FloatArray:
    """From each corner of parts ``(..., v, 2)`` to the next one, the same shape."""
    return np.asarray(np.concatenate([parts[..., 1:, :], parts[..., :1, :]], axis=-2) - parts)
