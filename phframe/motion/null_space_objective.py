"""Null-space objective: residuals of a configuration that is wide behind the gripper, near walls or near joint limits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import FloatArray, Shelf
from phframe.motion.pinocchio_ import Kinematics
from phframe.motion.surface_points import SurfacePoints
from phframe.urdf.description import Section

WALL_ROOM = 0.02
"""Wished for between the arm and the shelf (m)."""
WIDTH_ROOM = 0.005
"""By how much the arm should be narrower than it is described (m)."""
WALL_WEIGHT = 2.0
"""What a lack of that room counts, against as much too wide."""
OBSTACLE_ROOM, OBSTACLE_WEIGHT = 0.01, 4.0
"""Wished for between the arm and what it must not touch (m), and what a lack of it counts."""
LIMIT_FRACTION = 0.85
"""Of a joint's range, about its middle: to be kept to."""
LIMIT_WEIGHT, CENTER_WEIGHT = 0.3, 0.003
"""What a fraction of a joint's range beyond that counts, and one of the range itself (m)."""
MOUTH_ROOM = 0.05
"""What is farther than this before the mouth (m) meets no wall of the shelf."""


class NullSpaceObjective:
    """Judges joint values for a gripper pose in a shelf, by a sum of squares of residuals.

    Args:
        kinematics: Of the arm.
        surface: Points on the arm.
        behind: How wide the arm is described to be.
        shelf: The shelf.
    """

    def __init__(self, kinematics: Kinematics, surface: SurfacePoints, behind: Sequence[Section], shelf: Shelf) -> None:
        self._surface, self._shelf = surface, shelf
        self._middle = (kinematics.upper + kinematics.lower) / 2.0
        self._half = (kinematics.upper - kinematics.lower) / 2.0
        self._profiles = [np.array(section.widths) for section in behind]
        self._still = np.zeros(kinematics.dof)

    def residuals(
        self, q: FloatArray, direction: FloatArray, gripper: FloatArray, obstacles: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """What is wrong with joint values, and how that changes as they move in a direction.

        Args:
            q: Joint values ``(dof,)``.
            direction: Of the joints ``(dof,)``, with which the gripper stays.
            gripper: Its pose ``(3,)`` seen from above.
            obstacles: Upright cylinders to keep off ``(m, 4)``: x, y, radius and top (m), in the shelf frame.

        Returns:
            Residuals ``(k,)``, whose sum of squares is to be small, and their slopes ``(k,)``, in which the described
            width counts as the same all along the arm: what it changes by as a point moves to and from the fingertip
            is left out.
        """
        points, speeds = self._surface.seen(q, direction)
        width, width_slope = self._too_wide(points, speeds, gripper)
        room, room_slope = self._too_near(points, speeds)
        fraction, rate = (q - self._middle) / self._half, direction / self._half
        beyond = np.maximum(np.abs(fraction) - LIMIT_FRACTION, 0.0)
        limit_slope = np.where(beyond > 0.0, np.sign(fraction) * rate, 0.0)
        near, near_slope = _too_near_obstacles(points, speeds, obstacles)
        residuals = (width, room, near, LIMIT_WEIGHT * beyond, CENTER_WEIGHT * fraction)
        slopes = (width_slope, room_slope, near_slope, LIMIT_WEIGHT * limit_slope, CENTER_WEIGHT * rate)
        return np.concatenate(residuals), np.concatenate(slopes)

    def excess(self, q: FloatArray, gripper: FloatArray) -> float:
        """By how much the arm in the shelf is wider than it is described (m), 0 if nowhere."""
        points, speeds = self._surface.seen(q, self._still)
        wide = self._too_wide(points, speeds, gripper)[0]
        return max(0.0, float(wide.max(initial=0.0)) - WIDTH_ROOM)

    def _too_wide(self, points: FloatArray, speeds: FloatArray, gripper: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far points in the shelf stand out beyond the described width, less some room, and the slope of that.

        out = |across| - width(behind) + room; d out/dt = sign(across) d across/dt, without width'(behind) d behind/dt.
        """
        c, s = np.cos(gripper[2]), np.sin(gripper[2])
        x, y = points[:, 0] - gripper[0], points[:, 1] - gripper[1]
        across, behind = c * y - s * x, -(c * x + s * y)
        out = np.abs(across) - self._half_width(behind) + WIDTH_ROOM
        counts = (out > 0.0) & (points[:, 0] > 0.0)
        slope = np.sign(across) * (c * speeds[:, 1] - s * speeds[:, 0])
        return np.where(counts, out, 0.0), np.where(counts, slope, 0.0)

    def _half_width(self, behind: FloatArray) -> FloatArray:
        """Of the arm as described, by distance behind the fingertip ``(k,)`` (m)."""
        widths = [np.interp(behind, profile[:, 0], profile[:, 1]) for profile in self._profiles]
        return np.asarray(np.max(widths, axis=0)) if widths else np.full(len(behind), np.inf)

    def _too_near(self, points: FloatArray, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far points are too near to board, ceiling and walls, and the slope of that."""
        shelf, near = self._shelf, points[:, 0] > -MOUTH_ROOM
        rooms = (points[:, 2], shelf.height - points[:, 2], points[:, 1], shelf.width - points[:, 1])
        signs, axes = (-1.0, 1.0, -1.0, 1.0), (2, 2, 1, 1)
        lacking = np.array([np.where(near, np.maximum(WALL_ROOM - room, 0.0), 0.0) for room in rooms])
        slopes = np.array([sign * speeds[:, axis] for sign, axis in zip(signs, axes, strict=True)])
        return WALL_WEIGHT * lacking.ravel(), WALL_WEIGHT * np.where(lacking > 0.0, slopes, 0.0).ravel()


def _too_near_obstacles(points: FloatArray, speeds: FloatArray, obstacles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How far points are too near to obstacles, and the slope of that."""
    if not len(obstacles):
        return np.empty(0), np.empty(0)
    away = points[:, None, :2] - obstacles[None, :, :2]
    distance = np.maximum(np.hypot(away[..., 0], away[..., 1]), 1e-9)
    lacking = OBSTACLE_ROOM + obstacles[:, 2] - distance
    counts = (lacking > 0.0) & (points[:, None, 2] < obstacles[:, 3] + OBSTACLE_ROOM)
    slope = -(away * speeds[:, None, :2]).sum(axis=2) / distance
    return OBSTACLE_WEIGHT * lacking[counts], OBSTACLE_WEIGHT * slope[counts]
