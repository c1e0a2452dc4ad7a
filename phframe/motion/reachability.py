"""Reachability of a shelf: where an arm's fingertip can be from a base pose, by inverse kinematics spread from cell to cell."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Any, Protocol, runtime_checkable

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    Shelf,
    compose,
    inverse,
    planar_pose,
    rotation_matrix,
)
from phframe.core.value import Floats, Value

SPACING = 0.05
"""Of the grid of fingertip positions (m)."""
INSET = 0.05
"""Kept between the grid and mouth, walls and back (m): less than a gripper's half-width."""
YAWS = tuple(math.radians(degrees) for degrees in (0, 15, -15, 30, -30))
"""Of the gripper (rad), tried in this order."""
Cell = tuple[int, int]
BESIDE = ((0, -1), (-1, 0), (0, 1), (1, 0))
"""From a cell to the rows and columns of its neighbours."""


@runtime_checkable
class SupportsDescent(Protocol):
    """An arm whose inverse kinematics can be had without restarts: quickly where there is no solution."""

    def descend(self, pose: FloatArray, seed: FloatArray) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose ``(7,)`` in the frame of the base, downhill from a seed alone, or None."""

    @property
    def seeds(self) -> Sequence[FloatArray]:
        """Joint values ``(dof,)`` to begin from where nothing is known."""


@dataclass(frozen=True, slots=True, eq=False)
class Reachability(Value):
    """Which positions of the fingertip an arm can take, level in the gripper plane.

    Attributes:
        depths: x of the columns of the map ``(m,)`` in the shelf frame (m).
        widths: y of its rows ``(k,)`` (m).
        yaws: The yaw of least size at which each position is reached ``(k, m)`` (rad); infinite where none is.
    """

    depths: Floats
    widths: Floats
    yaws: Floats

    def __post_init__(self) -> None:
        self._freeze("depths", "widths", "yaws")

    @property
    def fraction(self) -> float:
        """Of the positions, those that are reached."""
        return float(np.isfinite(self.yaws).mean())


def reachability(shelf: Shelf, arm: ArmModel[Any], base_pose: BasePose, spacing: float = SPACING) -> Reachability:
    """Where over an empty shelf the fingertip can be, with the arm's outlines between the walls.

    Every cell is tried from the joint values of the cells beside it that are reached, until nothing new is: the joints
    of neighbours are near one another, so a descent is short where there is a solution. To begin with,
    cells all over the grid are tried from the arm's seeds. An arm without descent has its own inverse asked everywhere.

    Args:
        shelf: The shelf.
        arm: The arm.
        base_pose: Where its base stands.
        spacing: Of the positions tried (m).
    """
    fingertips = _Fingertips(shelf, arm, base_pose, spacing)
    yaws = np.full((len(fingertips.widths), len(fingertips.depths)), np.inf)
    if isinstance(arm, SupportsDescent):
        _spread(fingertips, arm, yaws)
    else:
        for cell in np.ndindex(*yaws.shape):
            found = (yaw for yaw, pose in fingertips.at(cell) if arm.inverse(pose) is not None)
            yaws[cell] = next(found, np.inf)
    return Reachability(fingertips.depths, fingertips.widths, yaws)


class _Fingertips:
    """What is asked of the fingertip over a shelf."""

    def __init__(self, shelf: Shelf, arm: ArmModel[Any], base_pose: BasePose, spacing: float) -> None:
        self._shelf, self._height = shelf, arm.shape.height
        self._base = inverse(base_pose.pose)
        self.depths, self.widths = _positions(shelf.depth, spacing), _positions(shelf.width, spacing)
        polygons = [outline.vertices for outline in arm.shape.closed]
        edges = np.array(
            [edge for polygon in polygons for edge in zip(polygon, np.roll(polygon, -1, axis=0), strict=True)]
        )
        self._edges = [(yaw, edges @ rotation_matrix(yaw).T) for yaw in YAWS]

    def at(self, cell: Cell) -> Iterator[tuple[float, FloatArray]]:
        """The yaws (rad) at which the outlines fit at a cell, each with the pose ``(7,)`` in the frame of the base."""
        x, y = float(self.depths[cell[1]]), float(self.widths[cell[0]])
        for yaw, edges in self._edges:
            if self._fit(edges + np.array([x, y])):
                yield yaw, compose(self._base, planar_pose(x, y, self._height, yaw))

    def _fit(self, edges: FloatArray) -> bool:
        """Whether outlines, given by their edges ``(k, 2, 2)``, are between the side walls wherever they are beyond the mouth."""
        (x0, y0), (x1, y1) = edges[:, 0].T, edges[:, 1].T
        crossing = (x0 < 0.0) != (x1 < 0.0)
        at_mouth = y0[crossing] + (y1 - y0)[crossing] * (x0 / np.where(crossing, x0 - x1, 1.0))[crossing]
        inside = np.concatenate([y0[x0 >= 0.0], at_mouth])
        return bool(((inside >= 0.0) & (inside <= self._shelf.width)).all())


Reached = tuple[float, FloatArray]
"""A yaw (rad), and joint values ``(dof,)``."""


def _spread(fingertips: _Fingertips, arm: SupportsDescent, yaws: FloatArray) -> None:
    """Fill in the yaws of all cells that are reached, breadth first (flood fill)."""
    cells = set(np.ndindex(*yaws.shape))
    found = {
        cell: reached
        for cell in _scattered(yaws.shape)
        if (reached := _solved(islice(fingertips.at(cell), 1), arm, arm.seeds))
    }
    waiting = deque(found)
    while waiting:
        row, column = cell = waiting.popleft()
        yaws[cell], q = found[cell]
        for beside in ((row + down, column + along) for down, along in BESIDE):
            if beside in cells and beside not in found and (reached := _solved(fingertips.at(beside), arm, [q])):
                found[beside] = reached
                waiting.append(beside)


def _scattered(shape: tuple[int, ...]) -> Iterator[Cell]:
    """Cells all over the grid, three rows of three."""
    rows, columns = (sorted({count // 6, count // 2, count - 1 - count // 6}) for count in shape)
    yield from product(rows, columns)


def _solved(asked: Iterator[Reached], arm: SupportsDescent, seeds: Sequence[FloatArray]) -> Reached | None:
    """The first yaw that is reached from any of the seeds."""
    solved = ((yaw, arm.descend(pose, seed)) for yaw, pose in asked for seed in seeds)
    return next(((yaw, q) for yaw, q in solved if q is not None), None)


def _positions(length: float, spacing: float) -> FloatArray:
    count = max(1, int((length - 2.0 * INSET) / spacing + 1e-9) + 1)
    start = (length - (count - 1) * spacing) / 2.0
    return np.asarray(start + spacing * np.arange(count, dtype=np.float64))
