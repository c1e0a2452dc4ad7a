"""A shelf in space as boxes: what every engine in space builds board, walls and ceiling from."""

from __future__ import annotations

from collections.abc import Iterator

from phframe.core import Shelf

THICKNESS = 0.1
"""Of board, walls and ceiling (m)."""
BOARD = "board"
WALLS = ("south wall", "north wall", "back wall", "ceiling")
Corner = tuple[float, float, float]


def board_box(shelf: Shelf) -> tuple[Corner, Corner]:
    """Least and greatest corner (m) of the board, which ends at the mouth."""
    return (0.0, -THICKNESS, -THICKNESS), (shelf.depth + THICKNESS, shelf.width + THICKNESS, 0.0)


def wall_boxes(shelf: Shelf) -> Iterator[tuple[str, Corner, Corner]]:
    """Name, least and greatest corner (m) of walls and ceiling."""
    depth, width, height, t = shelf.depth, shelf.width, shelf.height, THICKNESS
    yield "south wall", (0.0, -t, 0.0), (depth, 0.0, height)
    yield "north wall", (0.0, width, 0.0), (depth, width + t, height)
    yield "back wall", (depth, -t, 0.0), (depth + t, width + t, height)
    yield "ceiling", (0.0, -t, height), (depth + t, width + t, height + t)
