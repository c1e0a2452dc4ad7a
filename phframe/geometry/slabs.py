"""The shelf as boxes: what engines, collision models and files that other programs read are built from."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core.shelf import Shelf

Vector = tuple[float, float, float]
BOARD = "board"
THICK, PANEL = 0.1, 0.02
"""Of board, walls and ceiling (m): for engines, in which nothing shall get through, and for files."""
WALLS = ("south wall", "north wall", "back wall", "ceiling")


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


def slabs(shelf: Shelf, thickness: float = THICK) -> tuple[Slab, ...]:
    """The board, and after it the walls and the ceiling; the mouth is open.

    Args:
        shelf: The shelf.
        thickness: Of each of them (m), outwards.
    """
    depth, width, height, t = shelf.depth, shelf.width, shelf.height, thickness
    corners = (
        ((0.0, -t, -t), (depth + t, width + t, 0.0)),
        ((0.0, -t, 0.0), (depth, 0.0, height)),
        ((0.0, width, 0.0), (depth, width + t, height)),
        ((depth, -t, 0.0), (depth + t, width + t, height)),
        ((0.0, -t, height), (depth + t, width + t, height + t)),
    )
    return tuple(Slab(name, low, high) for name, (low, high) in zip((BOARD, *WALLS), corners, strict=True))
