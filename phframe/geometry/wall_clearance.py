"""How far an arm can move before one of its outlines meets a wall, exactly, at any angle.

A convex outline moved by t overlaps a convex wall when t lies inside their Minkowski difference, which is where
n . t < b for every edge normal n of either; so each pair is a handful of half-planes and each straight motion a clip.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import FloatArray, Outline, Shelf, rotation_matrix

FAR = 10.0
"""Thickness of the walls (m): more than any arm is long."""


class WallClearance:
    """The walls of a shelf as seen by an arm that keeps its yaw.

    Args:
        shelf: The shelf.
        outlines: Of the arm.
        yaw: Of the arm in the shelf frame (rad).
        margin: Distance to be kept from the walls (m).
    """

    def __init__(self, shelf: Shelf, outlines: Sequence[Outline], yaw: float, margin: float) -> None:
        arm, walls = _stacked([outline.vertices @ rotation_matrix(yaw).T for outline in outlines]), _walls(shelf)
        normals = _of_pairs(-_normals(arm), _normals(walls))
        over_walls = np.einsum("wvd,awkd->awkv", walls, normals).max(axis=3)
        over_arm = np.einsum("avd,awkd->awkv", -arm, normals).max(axis=3)
        # What has no length has no normal, and bounds nothing.
        bounds = np.where(normals.any(axis=3), over_walls + over_arm + margin, np.inf)
        self._normals = normals.reshape(-1, *normals.shape[2:])
        self._offsets = bounds.reshape(len(self._normals), -1)

    def travel(self, start: FloatArray, direction: FloatArray, distance: float) -> float:
        """How far the fingertip can move (m, at most ``distance``) from ``start`` ``(2,)`` along a unit vector ``(2,)``."""
        along = self._normals @ direction
        room = self._offsets - self._normals @ start
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            crossing = room / along
        enter = np.where(along < 0.0, crossing, np.where((along == 0.0) & (room <= 0.0), np.inf, -np.inf)).max(axis=1)
        leave = np.where(along > 0.0, crossing, np.inf).min(axis=1)
        hits = (enter < leave) & (leave > 0.0)
        return float(np.clip(enter[hits].min(initial=distance), 0.0, distance))

    def is_free(self, position: FloatArray) -> bool:
        """Whether the arm with its fingertip at ``(2,)`` keeps the margin from every wall."""
        return not bool((self._normals @ position < self._offsets).all(axis=1).any())


def _of_pairs(arm: FloatArray, walls: FloatArray) -> FloatArray:
    """The normals ``(a, w, v + u, 2)`` that bound each pair of a part ``(a, v, 2)`` and a wall ``(w, u, 2)``."""
    pairs = len(arm), len(walls)
    by_arm = np.broadcast_to(arm[:, None], (*pairs, *arm.shape[1:]))
    by_wall = np.broadcast_to(walls[None], (*pairs, *walls.shape[1:]))
    return np.concatenate([by_arm, by_wall], axis=2)


def _walls(shelf: Shelf) -> FloatArray:
    """South, north and back wall as rectangles ``(3, 4, 2)``, counter-clockwise."""
    d, w = shelf.depth, shelf.width
    spans = [(0.0, -FAR, d, 0.0), (0.0, w, d, w + FAR), (d, -FAR, d + FAR, w + FAR)]
    return np.array([[(x0, y0), (x1, y0), (x1, y1), (x0, y1)] for x0, y0, x1, y1 in spans])


def _stacked(polygons: Sequence[FloatArray]) -> FloatArray:
    """Polygons ``(m, v, 2)`` with their last vertex repeated up to the longest: an edge of no length bounds nothing."""
    longest = max(len(polygon) for polygon in polygons)
    return np.array([np.vstack([polygon, *[polygon[-1:]] * (longest - len(polygon))]) for polygon in polygons])


def _normals(polygons: FloatArray) -> FloatArray:
    """Outward unit normals ``(m, v, 2)`` of counter-clockwise polygons; zero for an edge of no length."""
    edges = np.concatenate([polygons[:, 1:], polygons[:, :1]], axis=1) - polygons
    lengths = np.hypot(edges[..., 0], edges[..., 1])
    lengths[lengths == 0.0] = 1.0
    return np.stack([edges[..., 1] / lengths, -edges[..., 0] / lengths], axis=2)
