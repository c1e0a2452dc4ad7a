"""How a shelf is drawn: thin walls, and a board just below what stands on it."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray, Shelf

BOARD_THICKNESS, WALL_THICKNESS = 0.012, 0.004
"""Thinner than any real one (m): they are there to be looked past."""
BELOW = 0.001
"""Between the board and what stands on it (m), so that what is drawn on the board is seen."""


def drawn_board(shelf: Shelf) -> FloatArray:
    """Least and greatest corner ``(2, 3)`` (m)."""
    return np.array([[0.0, 0.0, -BOARD_THICKNESS], [shelf.depth, shelf.width, -BELOW]])


def drawn_walls(shelf: Shelf) -> FloatArray:
    """Least and greatest corner of south, north and back wall ``(3, 2, 3)`` (m)."""
    depth, width, height, t = shelf.depth, shelf.width, shelf.height, WALL_THICKNESS
    south = [[0.0, -t, 0.0], [depth, 0.0, height]]
    north = [[0.0, width, 0.0], [depth, width + t, height]]
    return np.array([south, north, [[depth, 0.0, 0.0], [depth + t, width, height]]])
