"""Convex polygons in the plane: how far a point is from one."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray


def signed_distance(polygon: FloatArray, point: FloatArray) -> float:
    """From a convex, counter-clockwise polygon ``(k, 2)`` to a point ``(2,)``; inside it, minus the way to the next edge (m).

    With outward normals n_i and corners c_i it is max_i n_i . (p - c_i) where that is not positive.
    """
    edges = np.roll(polygon, -1, axis=0) - polygon
    lengths = np.hypot(*edges.T)
    edges, corners, lengths = edges[lengths > 0.0], polygon[lengths > 0.0], lengths[lengths > 0.0]
    away = point - corners
    outside = (away[:, 0] * edges[:, 1] - away[:, 1] * edges[:, 0]) / lengths
    if (outside <= 0.0).all():
        return float(outside.max())
    along = np.clip((away * edges).sum(axis=1) / lengths**2, 0.0, 1.0)
    return float(np.hypot(*(away - along[:, None] * edges).T).min())
