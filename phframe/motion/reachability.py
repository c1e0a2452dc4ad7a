"""Reachability of a shelf: where an arm's fingertip gets straight in through the mouth, from a base pose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np

from phframe.core import ArmModel, BasePose, FloatArray, GripperPath, Shelf
from phframe.core.value import Floats, Value
from phframe.geometry.arm_view import ArmView
from phframe.motion.straight_way import YAWS, straight_way

if TYPE_CHECKING:
    from phframe.motion.straight_reach import StraightReach

SPACING = 0.05
"""Of the grid of fingertip positions (m)."""
INSET = 0.03
"""Kept between the grid and mouth, walls and back (m): what stands there is no nearer, being as wide as the usual object."""
MOST_POSITIONS = 40
"""Of the grid along one axis: in larger shelves they are farther apart, so that a map is done in minutes at most."""
Cell = tuple[int, int]


@runtime_checkable
class SupportsStraightReach(Protocol):
    """An arm of joints that knows its straight ways into an empty shelf."""

    def straight_reach(self, shelf: Shelf, base_pose: BasePose) -> StraightReach:
        """The straight ways in with the base at a pose."""


@dataclass(frozen=True, slots=True, eq=False)
class Reachability(Value):
    """To which positions an arm gets straight in, level in the gripper plane.

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


def reachability(
    shelf: Shelf, arm: ArmModel[Any], base_pose: BasePose, spacing: float = SPACING, enough: float = 1.0
) -> Reachability:
    """To which positions over an empty shelf the closed gripper gets straight in, and straight out again.

    An arm of joints follows the way as it does when it plans (``StraightReach``). Of any other arm the outlines must
    pass between the walls, and the inverse kinematics must have the position.

    Args:
        shelf: The shelf.
        arm: The arm.
        base_pose: Where its base stands.
        spacing: Of the positions tried (m), as far as they are no more than ``MOST_POSITIONS`` along an axis.
        enough: Fraction of the positions from which on no more are tried: what is said of the others is then that they
            are not reached.
    """
    depths, widths = _positions(shelf.depth, spacing), _positions(shelf.width, spacing)
    yaws = np.full((len(widths), len(depths)), np.inf)
    if isinstance(arm, SupportsStraightReach):
        reach = arm.straight_reach(shelf, base_pose)
        found = _by_joints(reach, depths, widths, arm.shape.min_opening)
    else:
        found = _by_outlines(shelf, arm, base_pose, depths, widths)
    for cell, yaw in found:
        yaws[cell] = yaw
        if np.isfinite(yaws).mean() >= enough:
            break
    return Reachability(depths, widths, yaws)


Found = Iterator[tuple[Cell, float]]
"""Cells that are reached, each with its yaw (rad)."""


def _by_joints(reach: StraightReach, depths: FloatArray, widths: FloatArray, opening: float) -> Found:
    """Whole rows straight ahead, then what is left, cell by cell."""
    left = []
    for row, across in enumerate(widths.tolist()):
        deepest = reach.depth(across, opening, float(depths[-1]))
        for column, depth in enumerate(depths.tolist()):
            if depth <= deepest:
                yield (row, column), 0.0
            else:
                left.append((row, column))
    for row, column in left:
        yaws = reach.yaws((float(depths[column]), float(widths[row])), opening)
        yield from (((row, column), yaw) for yaw in yaws[:1])


def _by_outlines(
    shelf: Shelf, arm: ArmModel[Any], base_pose: BasePose, depths: FloatArray, widths: FloatArray
) -> Found:
    opening = arm.shape.min_opening
    view = ArmView(shelf, arm.shape.outlines(opening), 0.0)
    for row, column in np.ndindex(len(widths), len(depths)):
        place = float(depths[column]), float(widths[row])
        ways = ((yaw, straight_way(view, place, yaw, opening)) for yaw in YAWS)
        free = (yaw for yaw, way in ways if isinstance(way, GripperPath) and _has(arm, base_pose, way.poses[-1]))
        yield from (((row, column), yaw) for yaw in [next(free, None)] if yaw is not None)


def _has(arm: ArmModel[Any], base_pose: BasePose, pose: FloatArray) -> bool:
    """Whether inverse kinematics has a pose of the gripper ``(3,)``."""
    return arm.inverse(arm.fingertip_pose(pose, base_pose)) is not None


def _positions(length: float, spacing: float) -> FloatArray:
    count = max(1, int((length - 2.0 * INSET) / spacing + 1e-9) + 1)
    if count > MOST_POSITIONS:
        return np.linspace(INSET, length - INSET, MOST_POSITIONS)
    start = (length - (count - 1) * spacing) / 2.0
    return np.asarray(start + spacing * np.arange(count, dtype=np.float64))
