"""Cartesian waypoints: a gripper path as poses that follow one another closely."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from phframe.core import FloatArray, GripperPath, IntArray

TURN_SPACING = math.radians(1.5)
"""Most that the yaw changes between poses (rad)."""


@dataclass(frozen=True, slots=True, eq=False)
class CartesianWaypoints:
    """Poses along a path.

    Attributes:
        poses: ``(k, 3)`` x, y, yaw in the shelf frame.
        legs: The path's leg that leads to each pose ``(k,)``; of the first, the first.
        lengths: Way of the fingertip to each pose ``(k,)`` (m).
    """

    poses: FloatArray
    legs: IntArray
    lengths: FloatArray

    def turned(self, yaw: float) -> CartesianWaypoints:
        """The same with the gripper turned about the fingertip by an angle (rad)."""
        return replace(self, poses=self.poses + np.array([0.0, 0.0, yaw]))


def waypoints(path: GripperPath, spacing: float) -> CartesianWaypoints:
    """The corners of a path and poses between them, at most a spacing (m) apart; a leg that only opens the gripper has one."""
    poses, legs = [path.poses[:1]], [0]
    for leg, (start, end) in enumerate(zip(path.poses[:-1], path.poses[1:], strict=True)):
        count = _steps(end - start, spacing)
        fractions = np.arange(1, count + 1)[:, None] / count
        poses.append(start + fractions * (end - start))
        legs += [leg] * count
    found = np.vstack(poses)
    ways = np.hypot(*np.diff(found[:, :2], axis=0).T)
    return CartesianWaypoints(found, np.array(legs), np.concatenate([[0.0], np.cumsum(ways)]))


def _steps(step: FloatArray, spacing: float) -> int:
    moves, turns = math.hypot(step[0], step[1]) / spacing, abs(float(step[2])) / TURN_SPACING
    return max(1, math.ceil(max(moves, turns) - 1e-9))
