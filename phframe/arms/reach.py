"""Where over a shelf an arm's fingertip can be: what a base pose is worth."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    Outline,
    Scene,
    Shelf,
    compose,
    inverse,
    planar_pose,
    rotation_matrix,
)
from phframe.core.value import Floats, Value

SPACING = 0.025
"""Of the grid of fingertip positions (m)."""
COARSE_SPACING = 0.11
"""Of the grid for a quick answer (m): some 25 positions."""
INSET = 0.05
"""Kept between the grid and mouth, walls and back (m): less than a gripper's half-width."""
YAWS = tuple(math.radians(degrees) for degrees in (0, 15, -15, 30, -30))
"""Of the gripper (rad), tried in this order."""
Solve = Callable[[FloatArray, FloatArray | None], FloatArray | None]


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


def fraction_reachable(scene: Scene, arm: ArmModel[Any], base_pose: BasePose) -> float:
    """The fraction of the shelf over which the fingertip can be, level in the gripper plane, at a yaw within 30 degrees."""
    return reachability(scene, arm, base_pose, spacing=2.0 * SPACING).fraction


def reachability(scene: Scene, arm: ArmModel[Any], base_pose: BasePose, spacing: float = SPACING) -> Reachability:
    """Where over a shelf the fingertip can be, by inverse kinematics, with the arm's outlines between the walls.

    Args:
        scene: Whose shelf it is; objects do not count.
        arm: The arm.
        base_pose: Where its base stands.
        spacing: Of the positions tried (m).
    """
    return _reachability(scene.shelf, arm, base_pose, spacing, arm.inverse)


def fraction_served(shelf: Shelf, arm: ArmModel[Any], base_pose: BasePose, solve: Solve) -> float:
    """The same fraction as ``fraction_reachable``, on a coarse grid and with an inverse that may give up early: quickly.

    Args:
        shelf: The shelf.
        arm: The arm.
        base_pose: Where its base stands.
        solve: Joint values for a pose ``(7,)`` in the frame of the base, near others or near none; None: not found.
    """
    return _reachability(shelf, arm, base_pose, COARSE_SPACING, solve).fraction


def _reachability(shelf: Shelf, arm: ArmModel[Any], base_pose: BasePose, spacing: float, solve: Solve) -> Reachability:
    base = inverse(base_pose.pose)
    depths, widths = _positions(shelf.depth, spacing), _positions(shelf.width, spacing)
    yaws = np.full((len(widths), len(depths)), np.inf)
    found: dict[tuple[int, int], FloatArray] = {}
    for row, y in enumerate(widths.tolist()):
        for column, x in enumerate(depths.tolist()):
            for yaw in (yaw for yaw in YAWS if _fits(arm.shape.closed, x, y, yaw, shelf.width)):
                pose = compose(base, planar_pose(x, y, arm.shape.height, yaw))
                q = solve(pose, _neighbour(found, row, column))
                if q is not None:
                    yaws[row, column], found[row, column] = yaw, q
                    break
    return Reachability(depths, widths, yaws)


def _positions(length: float, spacing: float) -> FloatArray:
    count = max(1, int((length - 2.0 * INSET) / spacing + 1e-9) + 1)
    start = (length - (count - 1) * spacing) / 2.0
    return np.asarray(start + spacing * np.arange(count, dtype=np.float64))


def _neighbour(found: dict[tuple[int, int], FloatArray], row: int, column: int) -> FloatArray | None:
    """Joint values of a position beside, if one is known: the seed that keeps the posture."""
    return next((found[cell] for cell in ((row, column - 1), (row - 1, column)) if cell in found), None)


def _fits(outlines: tuple[Outline, ...], x: float, y: float, yaw: float, width: float) -> bool:
    """Whether the outlines, fingers closed, stand between the side walls wherever they are beyond the mouth."""
    tip = np.array([x, y])
    return all(
        0.0 <= across <= width
        for outline in outlines
        for across in _inside(outline.vertices @ rotation_matrix(yaw).T + tip)
    )


def _inside(polygon: FloatArray) -> Iterator[float]:
    """Where (y, m) the corners are of what lies beyond the mouth of a convex polygon ``(k, 2)``."""
    for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if x0 >= 0.0:
            yield y0
        if (x0 < 0.0) != (x1 < 0.0):
            yield y0 + (y1 - y0) * x0 / (x0 - x1)
