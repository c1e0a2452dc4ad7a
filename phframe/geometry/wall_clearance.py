"""How far an arm can move before one of its outlines meets a wall, exactly, at any angle.

A convex outline moved by t overlaps a convex wall when t lies inside their Minkowski difference, which is where
n . t < b for every edge normal n of either; so each pair is a handful of half-planes and each straight motion a clip.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phframe.core import FloatArray, Shelf
from phframe.geometry.parts import Angles, edges_of, turned, turns

FAR = 10.0
"""Thickness of the walls (m): more than any arm is long."""
LEVEL, TOUCH = 1e-300, 1e-18
"""A slope below the first is none; what is inside a half-plane by less than the second (m) only touches it."""


class WallClearance:
    """The walls of a shelf as seen by an arm that keeps its yaw; or, one by one, by arms at several yaws.

    Positions, directions and distances are one for each yaw, or one for all; further axes may stand before.

    Args:
        shelf: The shelf.
        parts: Of the arm, corners ``(m, v, 2)``, counter-clockwise, in the fingertip frame (m).
        yaws: Of the arm in the shelf frame.
        margin: Distance to be kept from the walls (m).

    Attributes:
        turns: ``(..., 2, 2)`` from the fingertip frame to the shelf frame.
        ahead: ``(..., 2)`` unit vectors along which the arm looks.
    """

    def __init__(self, shelf: Shelf, parts: FloatArray, yaws: Angles, margin: float) -> None:
        arm, walls = turned(parts, yaws), _walls(shelf)
        normals = _of_pairs(-_normals(arm), _normals(walls))
        over_walls = np.einsum("wvd,...awkd->...awkv", walls, normals).max(axis=-1)
        over_arm = np.einsum("...avd,...awkd->...awkv", -arm, normals).max(axis=-1)
        # What has no length has no normal, and bounds nothing.
        bounds = np.where(normals.any(axis=-1), over_walls + over_arm + margin, np.inf)
        pairs = (*normals.shape[:-4], -1, normals.shape[-2])
        self._normals = normals.reshape(*pairs, 2)
        self._offsets = bounds.reshape(pairs)
        self.turns = turns(yaws)
        self.ahead = self.turns[..., 0]
        self._outwards = _Slopes(_dot(self._normals, -self.ahead))

    def travel(self, start: FloatArray, direction: FloatArray, distance: ArrayLike) -> FloatArray:
        """How far the fingertip can move (m, at most ``distance``) from ``start`` ``(..., 2)`` along a unit vector ``(..., 2)``."""
        return self.room(start, direction, distance)[0]

    def room(self, start: FloatArray, direction: FloatArray, distance: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """How far it can move along a unit vector, and against it (m, at most ``distance``)."""
        enter, leave = self._overlaps(start, _Slopes(_dot(self._normals, direction)))
        hits = enter < leave
        ahead = np.where(hits & (leave > 0.0), enter, np.inf).min(axis=-1)
        back = np.where(hits & (enter < 0.0), -leave, np.inf).min(axis=-1)
        return np.minimum(np.maximum(ahead, 0.0), distance), np.minimum(np.maximum(back, 0.0), distance)

    def lets_out(self, tip: FloatArray, length: FloatArray) -> NDArray[np.bool_]:
        """Whether an arm with its fingertip at ``(..., 2)`` can draw straight back by a length (m), or come in this way."""
        enter, leave = self._overlaps(tip, self._outwards)
        hits = (enter < leave) & (leave > 0.0) & (enter < np.asarray(length)[..., None])
        return np.asarray(~hits.any(axis=-1))

    def is_free(self, position: FloatArray) -> NDArray[np.bool_]:
        """Whether the arm with its fingertip at ``(..., 2)`` keeps the margin from every wall."""
        return np.asarray(~(_dot(self._normals, position) < self._offsets).all(axis=-1).any(axis=-1))

    def _overlaps(self, start: FloatArray, slopes: _Slopes) -> tuple[FloatArray, FloatArray]:
        """From where to where on a straight line each part overlaps each wall, ``(..., p)`` (m); nowhere: the first is more."""
        crossing = (self._offsets - _dot(self._normals, start) - slopes.least) / slopes.along
        enter = np.where(slopes.falling, crossing, -np.inf).max(axis=-1)
        return enter, np.where(slopes.falling, np.inf, crossing).min(axis=-1)


class _Slopes:
    """How the distances from the half-planes change along a line ``(..., p, k)``.

    Where one does not change it falls, but so slowly that what is inside, by anything that counts, stays so all along.
    """

    def __init__(self, along: FloatArray) -> None:
        level = np.abs(along) < LEVEL
        self.along = np.where(level, -LEVEL, along)
        self.falling = self.along < 0.0
        self.least = np.where(level, TOUCH, 0.0)


def _dot(normals: FloatArray, vector: FloatArray) -> FloatArray:
    """Products ``(..., p, k)`` of normals ``(..., p, k, 2)`` and vectors ``(..., 2)``."""
    x, y = vector[..., 0, None, None], vector[..., 1, None, None]
    return np.asarray(normals[..., 0] * x + normals[..., 1] * y)  # not by BLAS: see core.rotated_in_plane_in_plane


def _of_pairs(arm: FloatArray, walls: FloatArray) -> FloatArray:
    """The normals ``(..., a, w, v + u, 2)`` that bound each pair of a part ``(..., a, v, 2)`` and a wall ``(w, u, 2)``."""
    pairs = (*arm.shape[:-2], len(walls))
    by_arm = np.broadcast_to(arm[..., None, :, :], (*pairs, *arm.shape[-2:]))
    by_wall = np.broadcast_to(walls, (*pairs, *walls.shape[1:]))
    return np.concatenate([by_arm, by_wall], axis=-2)


def _walls(shelf: Shelf) -> FloatArray:
    """South, north and back wall as rectangles ``(3, 4, 2)``, counter-clockwise."""
    d, w = shelf.depth, shelf.width
    spans = [(0.0, -FAR, d, 0.0), (0.0, w, d, w + FAR), (d, -FAR, d + FAR, w + FAR)]
    return np.array([[(x0, y0), (x1, y0), (x1, y1), (x0, y1)] for x0, y0, x1, y1 in spans])


def _normals(polygons: FloatArray) -> FloatArray:
    """Outward unit normals ``(..., v, 2)`` of counter-clockwise polygons; zero for an edge of no length."""
    edges = edges_of(polygons)
    lengths = np.hypot(edges[..., 0], edges[..., 1])
    lengths[lengths == 0.0] = 1.0
    return np.stack([edges[..., 1] / lengths, -edges[..., 0] / lengths], axis=-1)
