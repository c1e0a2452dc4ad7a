"""What an arm sweeps over as it moves straight on."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import FloatArray
from phframe.geometry.parts import edges_of


def distances_on_way_in(points: FloatArray, lower: FloatArray, upper: FloatArray, length: ArrayLike) -> FloatArray:
    """Distances ``(..., m, n)`` of points from the regions that parts of the arm sweep on a straight way in of a length (m).

    A region is bounded by the box around the part, drawn back along the way: parts are convex and narrow ahead, so the
    box is a close and safe bound.

    Args:
        points: ``(..., n, 2)`` in the frame of the fingertip at the end of the way (m).
        lower: Least x and y of each part ``(m, 2)`` (m).
        upper: Greatest x and y of each part ``(m, 2)`` (m).
        length: ``(...)`` (m).
    """
    x, y = points[..., None, :, 0], points[..., None, :, 1]
    back = lower[:, 0, None] - np.asarray(length)[..., None, None]
    ahead = np.maximum(np.maximum(back - x, x - upper[:, 0, None]), 0.0)
    across = np.maximum(np.maximum(lower[:, 1, None] - y, y - upper[:, 1, None]), 0.0)
    return np.asarray(np.hypot(ahead, across))


def swept_distances(parts: FloatArray, motion: FloatArray, points: FloatArray) -> FloatArray:
    """Distances ``(n, ...)`` of points from all that convex parts sweep over as they move straight on; 0 within (m).

    A part sweeps over its Minkowski sum with the motion, whose boundary consists of edges of the part where it begins and
    where it ends, and of ways of its corners.

    Args:
        parts: Corners ``(..., m, v, 2)`` where they begin, counter-clockwise (m).
        motion: From there to where they end ``(..., 2)`` (m).
        points: ``(n, 2)`` (m).
    """
    # Axes: coordinates, points, lines, parts and the rest, so that numpy's innermost loops are long.
    corners, edges = (
        np.ascontiguousarray(each.transpose(-1, -2, -3, *range(each.ndim - 3))) for each in (parts, edges_of(parts))
    )
    moved = np.broadcast_to(motion.transpose(-1, *range(motion.ndim - 1))[:, None, None], corners.shape)
    starts, count = np.concatenate([corners, corners + moved, corners], axis=1), corners.shape[1]
    x, y = np.concatenate([edges, edges, moved], axis=1)
    away_x, away_y = points.T.reshape(2, -1, *[1] * x.ndim) - starts[:, None]
    squares = x * x + y * y
    squares[squares == 0.0] = 1.0
    along = np.minimum(np.maximum((away_x * x + away_y * y) / squares, 0.0), 1.0)
    off_x, off_y = away_x - along * x, away_y - along * y
    distances = np.sqrt((off_x * off_x + off_y * off_y).min(axis=1))
    outside = away_x * y - away_y * x
    beyond = (np.minimum(outside[:, :count], outside[:, count : 2 * count]) > 0.0).any(axis=1)
    beside = outside[:, 2 * count :]
    within = ~beyond & (beside.min(axis=1) <= 0.0) & (beside.max(axis=1) >= 0.0)
    return np.asarray(np.where(within, 0.0, distances).min(axis=1))
