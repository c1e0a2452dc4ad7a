"""The measures of an arm's outlines that a pymunk world asks for again and again, in plain numbers, taken once."""

from __future__ import annotations

import math
from dataclasses import dataclass

from phframe.core import ArmShape, Outline

Box = tuple[float, float, float, float]
"""Least x, least y, greatest x, greatest y (m)."""


@dataclass(frozen=True, slots=True)
class Measures:
    """Of an arm with its fingers closed, in the fingertip frame.

    Attributes:
        corners: Of each part (m).
        boxes: Around each part.
        sides: Which way each part moves as the gripper opens.
        min_opening: Distance between the closed fingers (m).
        hull: Around all parts, however wide the gripper is open.
    """

    corners: tuple[tuple[tuple[float, float], ...], ...]
    boxes: tuple[Box, ...]
    sides: tuple[int, ...]
    min_opening: float
    hull: Box

    @property
    def length(self) -> float:
        """How far (m) anything of the arm is from its fingertip at most."""
        left, bottom, right, top = self.hull
        return math.hypot(max(-left, right), max(-bottom, top))

    def corners_at(self, opening: float) -> list[tuple[float, float]]:
        """All corners with the fingers ``opening`` (m) apart."""
        half = (opening - self.min_opening) / 2.0
        return [(x, y + side * half) for part, side in zip(self.corners, self.sides, strict=True) for x, y in part]

    def boxes_at(self, opening: float) -> list[Box]:
        """The boxes around the parts with the fingers ``opening`` (m) apart."""
        half = (opening - self.min_opening) / 2.0
        return [
            (left, bottom + side * half, right, top + side * half)
            for (left, bottom, right, top), side in zip(self.boxes, self.sides, strict=True)
        ]


def take_measures(shape: ArmShape) -> Measures:
    """Measure an arm."""
    boxes = tuple(_box(outline) for outline in shape.closed)
    widest = [*boxes, *(_box(outline) for outline in shape.outlines(shape.max_opening))]
    return Measures(
        tuple(tuple((x, y) for x, y in outline.vertices.tolist()) for outline in shape.closed),
        boxes,
        tuple(outline.side for outline in shape.closed),
        shape.min_opening,
        around(widest),
    )


def around(boxes: list[Box]) -> Box:
    """The box around some boxes."""
    left, bottom, right, top = zip(*boxes, strict=True)
    return min(left), min(bottom), max(right), max(top)


def _box(outline: Outline) -> Box:
    (left, bottom), (right, top) = outline.vertices.min(axis=0).tolist(), outline.vertices.max(axis=0).tolist()
    return left, bottom, right, top
