"""The shelf as boxes, for files that other programs read."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core import Shelf

THICKNESS = 0.02
"""Of board, walls and ceiling (m)."""
Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Slab:
    """A box along the axes of the shelf frame.

    Attributes:
        name: What it is.
        lower: Least corner (m).
        upper: Greatest corner (m).
    """

    name: str
    lower: Vector
    upper: Vector

    @property
    def center(self) -> Vector:
        """Its middle (m)."""
        a, b = self.lower, self.upper
        return (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, (a[2] + b[2]) / 2.0

    @property
    def size(self) -> Vector:
        """Its lengths along x, y and z (m)."""
        a, b = self.lower, self.upper
        return b[0] - a[0], b[1] - a[1], b[2] - a[2]


def slabs(shelf: Shelf) -> tuple[Slab, ...]:
    """Board, south, north and back wall and ceiling; the mouth is open."""
    depth, width, height, t = shelf.depth, shelf.width, shelf.height, THICKNESS
    return (
        Slab("board", (0.0, -t, -t), (depth + t, width + t, 0.0)),
        Slab("south wall", (0.0, -t, 0.0), (depth, 0.0, height)),
        Slab("north wall", (0.0, width, 0.0), (depth, width + t, height)),
        Slab("back wall", (depth, -t, 0.0), (depth + t, width + t, height)),
        Slab("ceiling", (0.0, -t, height), (depth + t, width + t, height + t)),
    )
