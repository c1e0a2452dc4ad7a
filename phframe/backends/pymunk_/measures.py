"""The measures of an arm's outlines that a pymunk world asks for again and again, taken once."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from phframe.core import ArmShape, FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Measures:
    """Of an arm with its fingers closed, in the fingertip frame.

    Attributes:
        corners: Of all parts ``(v, 2)`` (m).
        corner_sides: Which way each moves as the gripper opens ``(v,)``.
        lower: Least x and y of each part ``(m, 2)`` (m).
        upper: Greatest x and y of each part ``(m, 2)`` (m).
        sides: Which way each part moves as the gripper opens ``(m,)``.
        min_opening: Distance between the closed fingers (m).
        hull: Least x, least y, greatest x, greatest y of all parts, however wide the gripper is open (m).
    """

    corners: FloatArray
    corner_sides: FloatArray
    lower: FloatArray
    upper: FloatArray
    sides: FloatArray
    min_opening: float
    hull: tuple[float, float, float, float]

    @property
    def length(self) -> float:
        """How far (m) anything of the arm is from its fingertip at most."""
        left, bottom, right, top = self.hull
        return math.hypot(max(-left, right), max(-bottom, top))

    def corners_at(self, opening: float) -> FloatArray:
        """The corners with the fingers ``opening`` (m) apart."""
        return self.corners + _shift(self.corner_sides, opening - self.min_opening)

    def boxes_at(self, opening: float) -> tuple[FloatArray, FloatArray]:
        """Least and greatest x and y of each part with the fingers ``opening`` (m) apart."""
        shift = _shift(self.sides, opening - self.min_opening)
        return self.lower + shift, self.upper + shift


def take_measures(shape: ArmShape) -> Measures:
    """Measure an arm."""
    parts = [outline.vertices for outline in shape.closed]
    widest = np.vstack([part for at in (shape.min_opening, shape.max_opening) for part in _vertices(shape, at)])
    sides = [float(outline.side) for outline in shape.closed]
    return Measures(
        np.vstack(parts),
        np.repeat(sides, [len(part) for part in parts]),
        np.array([part.min(axis=0) for part in parts]),
        np.array([part.max(axis=0) for part in parts]),
        np.array(sides),
        shape.min_opening,
        (*widest.min(axis=0).tolist(), *widest.max(axis=0).tolist()),
    )


def _vertices(shape: ArmShape, opening: float) -> list[FloatArray]:
    return [outline.vertices for outline in shape.outlines(opening)]


def _shift(sides: FloatArray, distance: float) -> FloatArray:
    return np.column_stack([np.zeros(len(sides)), sides * (distance / 2.0)])
