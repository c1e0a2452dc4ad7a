"""How far an arm stands out to either side at a given depth, seen in the corridor frame."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import FloatArray, Outline, rotation_matrix
from phframe.geometry.convex_hull import convex_hull
from phframe.geometry.polygon import signed_distance


class Silhouette:
    """The outlines of an arm that is tilted against the corridor, with the fingertip at the origin.

    Args:
        outlines: Of the arm.
        tilt: Against the corridor (rad).
    """

    def __init__(self, outlines: Sequence[Outline], tilt: float) -> None:
        self._polygons = [outline.vertices @ rotation_matrix(tilt).T for outline in outlines]
        self._starts = np.concatenate(self._polygons)
        self._ends = np.concatenate([np.vstack([polygon[1:], polygon[:1]]) for polygon in self._polygons])
        self.front = float(self._starts[:, 0].max())

    def side(self, depths: FloatArray, direction: int) -> FloatArray:
        """How far the arm reaches to one side (+1 or -1) of the fingertip at depths ``(k,)``, ``(k,)`` (m).

        Ahead of the arm it is what its front reaches: that is what meets an object standing there.
        """
        x = np.minimum(depths, self.front)[:, None]
        x0, x1 = self._starts[:, 0], self._ends[:, 0]
        crosses = (np.minimum(x0, x1) <= x) & (x <= np.maximum(x0, x1))
        with np.errstate(divide="ignore", invalid="ignore"):
            fraction = np.where(x0 == x1, 0.0, (x - x0) / (x1 - x0))
        y0, y1 = self._starts[:, 1], self._ends[:, 1]
        reach = np.where(x0 == x1, np.maximum(direction * y0, direction * y1), direction * (y0 + fraction * (y1 - y0)))
        return np.asarray(np.where(crosses, reach, -np.inf).max(axis=1))

    def meets(self, points: FloatArray, radius: float, start: FloatArray, end: FloatArray) -> bool:
        """Whether it comes nearer than a radius (m) to any of the points ``(k, 2)`` as its fingertip goes straight on.

        A convex part sweeps over the convex hull of where it is first and last.

        Args:
            points: In the frame that the arm is tilted against (m).
            radius: Of the round objects there (m).
            start: Where the fingertip is at first ``(2,)`` (m).
            end: Where it is in the end ``(2,)`` (m).
        """
        swept = (convex_hull(np.concatenate([part + start, part + end])) for part in self._polygons)
        return any(signed_distance(region, point) < radius for region in swept for point in points)

    def widest_side(self, nearest: float, farthest: float, direction: int) -> float:
        """The most it reaches to one side between two depths (m)."""
        between = self._starts[:, 0][(self._starts[:, 0] > nearest) & (self._starts[:, 0] < farthest)]
        return float(self.side(np.array([nearest, farthest, *between]), direction).max())
