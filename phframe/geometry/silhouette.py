"""How far an arm stands out to either side at a given depth, seen in the corridor frame."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import FloatArray
from phframe.geometry.parts import Angles, edges_of, turned, turns


class Silhouette:
    """The outlines of an arm that is tilted against the corridor; or, one by one, at several tilts. The fingertip is at the origin.

    Depths and directions are one for each tilt, on the last axis, or one for all.

    Args:
        parts: Of the arm, corners ``(m, v, 2)``, counter-clockwise, in the fingertip frame (m).
        tilts: Against the corridor.

    Attributes:
        turns: ``(..., 2, 2)`` from the fingertip frame to the one that it is tilted against.
        parts: The parts, tilted: ``(..., m, v, 2)``.
        front: ``(...)`` how far the foremost point is ahead of the fingertip (m).
        lowest: ``(...)`` least y of all points (m).
        highest: ``(...)`` greatest y of all points (m).
    """

    def __init__(self, parts: FloatArray, tilts: Angles) -> None:
        self.turns, self.parts = turns(tilts), turned(parts, tilts)
        (self._x, self._y), (ends_x, ends_y) = (
            _by_corner(each) for each in (self.parts, np.roll(self.parts, -1, axis=-2))
        )
        runs, rises = _by_corner(edges_of(self.parts))
        upright = runs == 0.0
        self._runs, self._rises = np.where(upright, 1.0, runs), np.where(upright, 0.0, rises)
        self._nearest, self._farthest = np.minimum(self._x, ends_x), np.maximum(self._x, ends_x)
        self._north, self._south = (
            np.where(upright, most(self._y, ends_y), self._y) for most in (np.maximum, np.minimum)
        )
        self.front, self.lowest, self.highest = self._x.max(axis=0), self._y.min(axis=0), self._y.max(axis=0)

    def side(self, depths: FloatArray, direction: ArrayLike) -> FloatArray:
        """How far the arm reaches to one side (+1 or -1) of the fingertip at depths ``(k, ...)``, the same shape (m).

        Ahead of the arm it is what its front reaches: that is what meets an object standing there.
        """
        way = np.asarray(direction)
        bases, rises = np.where(way > 0, self._north, -self._south), way * self._rises
        x = np.minimum(depths, self.front)
        crosses = (self._nearest[:, None] <= x) & (x <= self._farthest[:, None])
        with np.errstate(over="ignore", invalid="ignore"):
            reach = bases[:, None] + (x - self._x[:, None]) / self._runs[:, None] * rises[:, None]
        return np.asarray(np.where(crosses, reach, -np.inf).max(axis=0))

    def widest_side(self, nearest: ArrayLike, farthest: ArrayLike, direction: ArrayLike) -> FloatArray:
        """The most it reaches to one side between two depths ``(...)``, ``(...)`` (m)."""
        north, south = self._corner_sides
        corners = np.where(np.asarray(direction) > 0, north, south)
        between = np.where((self._x > nearest) & (self._x < farthest), corners, -np.inf).max(axis=0)
        at_ends = self.side(np.array([nearest, farthest]), direction).max(axis=0)
        return np.asarray(np.maximum(at_ends, between))

    @cached_property
    def tip_sides(self) -> tuple[FloatArray, FloatArray]:
        """How far it reaches to the north, and to the south, at the depth of the fingertip ``(...)`` (m)."""
        tip = np.zeros((1, *self.front.shape))
        return self.side(tip, 1)[0], self.side(tip, -1)[0]

    @cached_property
    def _corner_sides(self) -> tuple[FloatArray, FloatArray]:
        """How far it reaches to the north, and to the south, at the depth of each corner ``(e, ...)`` (m)."""
        return self.side(self._x, 1), self.side(self._x, -1)


def _by_corner(parts: FloatArray) -> FloatArray:
    """Parts ``(..., m, v, 2)`` as x and y of all corners ``(2, m v, ...)``: what is many comes last, for numpy's sake."""
    corners = parts.reshape(*parts.shape[:-3], -1, 2)
    return np.ascontiguousarray(np.moveaxis(corners, (-1, -2), (0, 1)))
