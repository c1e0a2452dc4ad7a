"""The shelf in 3D and from the top; logged once."""

from __future__ import annotations

import numpy as np
import rerun as rr

from phframe.core import FloatArray, Shelf
from phframe.recorders import palette
from phframe.recorders.filling import filling
from phframe.recorders.shelf_look import drawn_board, drawn_walls
from phframe.recorders.stream import Stream

FILLING_LINES = 60


def log_shelf(stream: Stream, shelf: Shelf) -> None:
    """Board, walls of glass, edges; from the top also which side is which."""
    stream.keep("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
    # The viewer's 2D views have y down; mirrored, everything below can be given in the shelf frame, north up.
    stream.keep("top", rr.Transform3D(mat3x3=np.diag([1.0, -1.0, 1.0])))
    _log_solid(stream, shelf)
    _log_plan_view(stream, shelf)


def _log_solid(stream: Stream, shelf: Shelf) -> None:
    stream.keep("world/shelf/board", _boxes(drawn_board(shelf)[None], palette.BOARD))
    stream.keep("world/shelf/walls", _boxes(drawn_walls(shelf), palette.WALL))
    stream.keep("world/shelf/edges", rr.LineStrips3D(_edges(shelf), colors=palette.EDGE, radii=-0.7))


def _boxes(corners: FloatArray, color: palette.Color) -> rr.Boxes3D:
    lower, upper = corners[:, 0], corners[:, 1]
    return rr.Boxes3D(centers=(lower + upper) / 2, half_sizes=(upper - lower) / 2, colors=color, fill_mode="solid")


def _edges(shelf: Shelf) -> list[FloatArray]:
    outline = _outline(shelf)
    levels = [np.column_stack([outline, np.full(len(outline), z)]) for z in (0.0, shelf.height)]
    return [*levels, *(np.array(corner) for corner in zip(*levels, strict=True))]


def _outline(shelf: Shelf) -> FloatArray:
    """The shelf seen from above, from the mouth's south corner round to it again."""
    depth, width = shelf.depth, shelf.width
    return np.array([[0.0, 0.0], [depth, 0.0], [depth, width], [0.0, width], [0.0, 0.0]])


def _log_plan_view(stream: Stream, shelf: Shelf) -> None:
    lines, radius = filling(_outline(shelf)[:4], FILLING_LINES)
    board = rr.LineStrips2D(lines, radii=radius, colors=palette.BOARD, draw_order=-50.0)
    stream.keep("top/shelf/board", board)
    walls = _outline(shelf)[:4]  # the mouth, between the last corner and the first, stays open
    stream.keep("top/shelf/walls", rr.LineStrips2D([walls], radii=-1.5, colors=palette.EDGE, draw_order=20.0))
    stream.keep("top/shelf/sides", _side_names(shelf))


def _side_names(shelf: Shelf) -> rr.Points2D:
    places = [[shelf.depth / 2, shelf.width + 0.042], [shelf.depth / 2, -0.012], [-0.045, 0.02]]
    return rr.Points2D(
        places,
        radii=0.0,
        colors=palette.TEXT,
        labels=["north", "south", "mouth"],
        show_labels=True,
    )
