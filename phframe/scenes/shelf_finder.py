"""Finds a shelf among boxes: a board on which bodies stand, two side walls and a back wall; what is open is the mouth.

All is done in a frame turned with the board about the vertical, in which the boxes that matter lie along the axes.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from phframe.core import FloatArray, SceneError, Shelf, rotation_matrix
from phframe.scenes.foreign import Block, FreeBody, coefficient, listed

STANDS_WITHIN = 0.02
"""A body whose underside is no farther than this from a top face (m) stands on it."""
SQUARE = 1e-3
"""How far the axes of a box may be from those of the shelf (sine of the angle)."""
BESIDE = 0.05
"""A wall is no farther than this from the board's edge (m)."""
DIGITS = 9
"""Lengths are rounded to nanometres: what was computed on the way is not in them."""
SIDES = ((0, 1), (0, -1), (1, 1), (1, -1))
"""Axis and direction of the four sides, as seen in the turned frame."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a shelf stands in a world.

    Attributes:
        shelf: Its inside.
        origin: Of the shelf frame (m).
        yaw: Of the shelf frame (rad).
        board: What the bodies stand on.
        walls: South, north and back wall.
        ceiling: What is above; None: nothing.
        standing: Those that stand on the board.
        notes: What is to be said about it.
    """

    shelf: Shelf
    origin: tuple[float, float, float]
    yaw: float
    board: Block
    walls: tuple[Block, Block, Block]
    ceiling: Block | None
    standing: tuple[FreeBody, ...]
    notes: tuple[str, ...] = ()

    @property
    def used(self) -> tuple[Block, ...]:
        """The boxes that are the shelf."""
        return (self.board, *self.walls, *(() if self.ceiling is None else (self.ceiling,)))

    def seen(self, point: FloatArray) -> FloatArray:
        """A point ``(3,)`` of the world in the shelf frame (m)."""
        moved = np.asarray(point) - self.origin
        return np.array([*(rotation_matrix(-self.yaw) @ moved[:2]), moved[2]])


@dataclass(frozen=True, slots=True)
class _Extent:
    """A box along the axes of the turned frame."""

    block: Block
    lower: FloatArray
    upper: FloatArray


def find_shelf(blocks: Sequence[Block], bodies: Sequence[FreeBody]) -> Place:
    """The shelf in which most bodies stand.

    Raises:
        SceneError: If there is none; it says what was found instead.
    """
    board, standing = _board(blocks, bodies)
    yaw = _yaw(board) if not board.endless else _usual_yaw(blocks)
    extents = [extent for block in blocks if (extent := _extent(block, yaw)) is not None]
    under = next(extent for extent in extents if extent.block is board)
    centers = np.array([rotation_matrix(-yaw) @ body.center[:2] for body in standing])
    top = max(body.height for body in standing) + float(under.upper[2])
    walls = {side: wall for side in SIDES if (wall := _wall(side, under, extents, centers, top)) is not None}
    mouth = _mouth(walls, under)
    above = _ceiling(extents, under, centers, top)
    return _placed(yaw, under, mouth, walls, above, standing, top)


def _board(blocks: Sequence[Block], bodies: Sequence[FreeBody]) -> tuple[Block, tuple[FreeBody, ...]]:
    """What most bodies stand on, the smallest of those, and the bodies that do."""
    found = [
        (len(on), -float(np.prod(np.sort(block.half)[1:])), number, on)
        for number, block in enumerate(blocks)
        if (on := tuple(body for body in bodies if _stands(body, block)))
    ]
    if not found:
        raise SceneError(
            f"no shelf: none of the {len(bodies)} free bodies stands on a level box or plane that is fixed to the world"
        )
    *_, number, on = max(found, key=lambda each: each[:2])
    return blocks[number], on


def _stands(body: FreeBody, block: Block) -> bool:
    extent = _extent(block, _yaw(block))
    if extent is None or abs(body.base - extent.upper[2]) > STANDS_WITHIN:
        return False
    x, y = rotation_matrix(-_yaw(block)) @ body.center[:2]
    return bool(extent.lower[0] <= x <= extent.upper[0] and extent.lower[1] <= y <= extent.upper[1])


def _yaw(block: Block) -> float:
    """Of the first level axis, within 45 degrees of the world's."""
    level = next((axis for axis in block.axes.T if abs(axis[2]) < 0.5), block.axes[:, 0])
    yaw = math.atan2(level[1], level[0])
    return yaw - round(yaw / (math.pi / 2.0)) * math.pi / 2.0


def _usual_yaw(blocks: Iterable[Block]) -> float:
    """Of most boxes."""
    yaws = [round(_yaw(block), 6) for block in blocks if not block.endless]
    return Counter(yaws).most_common(1)[0][0] if yaws else 0.0


def _extent(block: Block, yaw: float) -> _Extent | None:
    """The box in a frame turned by a yaw, if it lies along its axes."""
    turned = np.eye(3)
    turned[:2, :2] = rotation_matrix(-yaw)
    axes = np.abs(turned @ block.axes)
    looked_at = axes[:, 2:] if block.endless else axes  # a plane may be turned about its normal
    if (np.minimum(looked_at, 1.0 - looked_at) > SQUARE).any():
        return None
    center = turned @ block.center
    half = block.half if block.endless else np.round(axes) @ block.half
    return _Extent(block, center - half, center + half)


def _wall(
    side: tuple[int, int], board: _Extent, extents: Iterable[_Extent], centers: FloatArray, top: float
) -> _Extent | None:
    """The nearest box on one side of the standing bodies."""
    axis, sign = side
    floor, first, last = board.upper[2], centers.min(axis=0), centers.max(axis=0)
    found = [
        extent
        for extent in extents
        if extent.block is not board.block
        and extent.lower[2] < top
        and extent.upper[2] > floor + STANDS_WITHIN
        and extent.lower[1 - axis] <= last[1 - axis]
        and extent.upper[1 - axis] >= first[1 - axis]
        and sign * _face(extent, side) >= max(sign * first[axis], sign * last[axis])
        and sign * (_face(extent, side) - _edge(board, side)) <= BESIDE
    ]
    return min(found, key=lambda extent: sign * _face(extent, side), default=None)


def _face(extent: _Extent, side: tuple[int, int]) -> float:
    """Where a wall on that side begins, seen from inside (m)."""
    axis, sign = side
    return float((extent.lower if sign > 0 else extent.upper)[axis])


def _edge(extent: _Extent, side: tuple[int, int]) -> float:
    """Where it ends on that side (m)."""
    axis, sign = side
    return float((extent.upper if sign > 0 else extent.lower)[axis])


def _mouth(walls: dict[tuple[int, int], _Extent], board: _Extent) -> tuple[int, int]:
    """The side that is open.

    Raises:
        SceneError: If not one is, but none or several.
    """
    if len(walls) == len(SIDES) - 1:
        return next(side for side in SIDES if side not in walls)
    names = listed(wall.block.name for wall in walls.values()) or "none"
    raise SceneError(
        f"no shelf: around what stands on {board.block.name!r} there are walls on {len(walls)} of four sides ({names}); a "
        "shelf has them on three, and is open on the fourth. Walls are boxes or planes fixed to the world, square to the board"
    )


def _ceiling(extents: Iterable[_Extent], board: _Extent, centers: FloatArray, top: float) -> _Extent | None:
    found = [
        extent
        for extent in extents
        if extent.block is not board.block
        and extent.lower[2] >= top - 1e-6
        and (extent.lower[:2] <= centers.max(axis=0)).all()
        and (extent.upper[:2] >= centers.min(axis=0)).all()
    ]
    return min(found, key=lambda extent: float(extent.lower[2]), default=None)


def _placed(
    yaw: float,
    board: _Extent,
    mouth: tuple[int, int],
    walls: dict[tuple[int, int], _Extent],
    above: _Extent | None,
    standing: tuple[FreeBody, ...],
    top: float,
) -> Place:
    axis, sign = mouth
    back = (axis, -sign)
    low, high = walls[1 - axis, -1], walls[1 - axis, 1]
    near = -sign * max(-sign * _edge(extent, mouth) for extent in (board, _shorter(low, high, mouth)))
    depth = abs(_face(walls[back], back) - near)
    width = _face(high, (1 - axis, 1)) - _face(low, (1 - axis, -1))
    floor = float(board.upper[2])
    notes: list[str] = []
    height = _height(above, (low, high, walls[back]), floor, top, notes)
    inward = yaw + {(0, -1): 0.0, (0, 1): math.pi, (1, -1): math.pi / 2.0, (1, 1): -math.pi / 2.0}[mouth]
    south, north = (low, high) if mouth in ((0, -1), (1, 1)) else (high, low)
    corner = np.empty(2)
    corner[axis], corner[1 - axis] = near, _face(south, (1 - axis, -1 if south is low else 1))
    x, y = rotation_matrix(yaw) @ corner
    blocks = (south.block, north.block, walls[back].block)
    ceiling = None if above is None else above.block
    shelf = _shelf(depth, width, height, board.block, blocks, standing, notes)
    origin = _rounded(x), _rounded(y), _rounded(floor)
    heading = _rounded(math.remainder(inward, 2.0 * math.pi))
    return Place(shelf, origin, heading, board.block, blocks, ceiling, standing, tuple(notes))


def _shorter(low: _Extent, high: _Extent, mouth: tuple[int, int]) -> _Extent:
    """Of two side walls the one that reaches farther out of the mouth: the arm comes between them there."""
    return max((low, high), key=lambda extent: mouth[1] * _edge(extent, mouth))


def _height(above: _Extent | None, walls: Iterable[_Extent], floor: float, top: float, notes: list[str]) -> float:
    if above is not None:
        return float(above.lower[2]) - floor
    height = max(min(float(wall.upper[2]) for wall in walls), top) - floor
    notes.append(f"there is no ceiling; the shelf is taken to be {height:g} m high, as its walls")
    return height


def _shelf(
    depth: float,
    width: float,
    height: float,
    board: Block,
    walls: Iterable[Block],
    standing: Iterable[FreeBody],
    notes: list[str],
) -> Shelf:
    found = {coefficient(wall, body) for wall in walls for body in standing}
    if len(found) > 1:
        notes.append(
            f"walls and objects have {len(found)} coefficients of friction; the greatest is taken, {max(found):g}"
        )
    return Shelf(_rounded(depth), _rounded(width), _rounded(height), board.friction, max(found))


def _rounded(number: float) -> float:
    return round(float(number), DIGITS) + 0.0
