"""Differential inverse kinematics: joints that follow the gripper's pose, with null-space motion towards an objective."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from phframe.core import FloatArray
from phframe.motion.least_squares import damped_least_squares, null_space_direction
from phframe.motion.null_space_objective import NullSpaceObjective
from phframe.motion.pinocchio_ import Kinematics

REACHED = 1e-6
"""Norm of the twist (m, rad) that is left when a pose counts as reached."""
STEPS = 8
"""Most iterations to one pose."""
LONGEST_NULL_MOTION = 0.03
"""Most that the joints move in the null space while the gripper goes on by one waypoint (rad or m, norm)."""
LONGEST_CHANGE = 0.003
"""Most that the null-space motion changes from one waypoint to the next: joints shall move smoothly."""
HASTE = 5
"""Waypoints that count as gone by for every improvement of a configuration on the spot."""
LONGEST_STEP = 0.2
"""Most that any joint moves from one waypoint to the next (rad or m): more is a jump to another configuration."""
STIFFNESS = 1e-6
"""Damping of the Gauss-Newton step: keeps the joints still where nothing is gained by moving them."""
LIMIT_ROOM = 0.01
"""Kept from the joints' limits (rad or m), for the curves between waypoints to bend in."""
DAMPING = 1e-9
"""Damping of the pose step, where joints can hardly make up for an error, or not at all."""


class DifferentialIK:
    """Takes an arm from pose to pose by joint values that change continuously.

    Each pose is reached by damped least squares; redundant joints also move in the null space of the first Jacobian,
    ``dq = J^+ e + (I - J^+ J) z`` (A. Liegeois, "Automatic supervisory control of the configuration and behavior of
    multibody mechanisms", 1977), where ``z`` is a Gauss-Newton step of the objective along the null space.

    Args:
        kinematics: Of the arm.
        objective: What a good configuration is.
        obstacles: Upright cylinders ``(m, 4)`` for the arm to keep off: x, y, radius and top (m), in the shelf frame.
    """

    def __init__(self, kinematics: Kinematics, objective: NullSpaceObjective, obstacles: FloatArray) -> None:
        self._kinematics, self._objective, self._obstacles = kinematics, objective, obstacles
        room = np.minimum(LIMIT_ROOM, (kinematics.upper - kinematics.lower) / 4.0)
        self._lower, self._upper = kinematics.lower + room, kinematics.upper - room

    def step(
        self, q: FloatArray, null_motion: FloatArray, target: Any, gripper: FloatArray, stride: int = 1
    ) -> tuple[FloatArray, FloatArray] | None:
        """Joint values for a pose near the one that ``q`` has, or None.

        Args:
            q: Joint values ``(dof,)``.
            null_motion: The null-space motion ``(dof,)`` per waypoint on the way to ``q``.
            target: The pose, as the kinematics want it.
            gripper: The same seen from above ``(3,)``, in the shelf frame.
            stride: How many waypoints it is away.

        Returns:
            The joint values, and the null-space motion per waypoint on the way to them.
        """
        kinematics, begin = self._kinematics, q
        for step in range(STEPS):
            error, jacobian = kinematics.error(q, target)
            if step and float(error @ error) < REACHED**2:
                return (q, null_motion) if float(np.abs(q - begin).max()) < LONGEST_STEP * stride**0.5 else None
            move = damped_least_squares(jacobian, error, DAMPING)
            if step == 0 and len(q) > 6:
                null_motion = self._null_motion(q, null_motion, jacobian, gripper, stride)
                move = move + stride * null_motion
            q = self._moved(q, move, jacobian, error)
        return None

    def improved(self, q: FloatArray, target: Any, gripper: FloatArray, times: int) -> FloatArray | None:
        """Joint values after so many improvements in the null space, the gripper at one pose, or None where it is lost."""
        null_motion = np.zeros(len(q))
        for _ in range(times):
            found = self.step(q, null_motion, target, gripper, HASTE)
            if found is None:
                return None
            q, null_motion = found
        return q

    def joints_at_limits(self, q: FloatArray) -> Sequence[int]:
        """Numbers of the joints that stand at a limit."""
        at = (q <= self._lower + 1e-6) | (q >= self._upper - 1e-6)
        return [int(row) for row in np.flatnonzero(at)]

    def _moved(self, q: FloatArray, move: FloatArray, jacobian: FloatArray, error: FloatArray) -> FloatArray:
        """After a move; joints that would leave their limits stop there, and the others do their work.

        Saturation in the null space, of one round (F. Flacco, A. De Luca, O. Khatib, "Motion control of redundant
        robots under joint constraints", 2012).
        """
        to = np.clip(q + move, self._lower, self._upper)
        stopped = to != q + move
        if not stopped.any():
            return to
        kept = np.where(stopped, to - q, 0.0)
        others = np.where(stopped, 0.0, jacobian)
        kept = kept + damped_least_squares(others, error - jacobian @ kept, DAMPING)
        return np.asarray(np.clip(q + kept, self._lower, self._upper))

    def _null_motion(
        self, q: FloatArray, last: FloatArray, jacobian: FloatArray, gripper: FloatArray, stride: int
    ) -> FloatArray:
        """A Gauss-Newton step ``(dof,)`` along the null space, per waypoint, not far from the last one.

        Along the unit direction ``n`` with ``J n = 0``, residuals ``r`` with slopes ``s = dr/dn`` are least, to first
        order, after ``-(r . s) / (s . s + mu)``.
        """
        direction = null_space_direction(jacobian)
        residuals, slopes = self._objective.residuals(q, direction, gripper, self._obstacles)
        wanted = -float(residuals @ slopes) / (float(slopes @ slopes) + STIFFNESS) / stride
        before, change = float(last @ direction), LONGEST_CHANGE * stride
        step = min(max(wanted, before - change, -LONGEST_NULL_MOTION), before + change, LONGEST_NULL_MOTION)
        return np.asarray(step * direction)
