"""Follows gripper poses in the gripper plane with joints that change continuously, in the best posture at hand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from phframe.core import FloatArray
from phframe.motion.pinocchio_ import Kinematics, least_squares
from phframe.motion.posture import Posture

REACHED = 1e-6
"""What is left of position (m) and turn (rad) together when a pose counts as reached."""
STEPS = 8
"""Most steps to one pose."""
LONGEST_DRIFT = 0.03
"""Of the joints for the sake of the posture while the gripper goes on by one spacing of a path (rad or m, norm)."""
LONGEST_CHANGE = 0.003
"""Of that from one spacing to the next: joints shall move smoothly."""
HASTE = 5
"""Spacings of a path that count as gone by for every improvement of a posture on the spot."""
LONGEST_STEP = 0.2
"""Of any joint meanwhile (rad or m): more is another posture."""
STIFFNESS = 1e-6
"""Keeps the posture where nothing is gained by changing it."""

LIMIT_ROOM = 0.01
"""Kept from the joints' limits (rad or m), for the curves between poses to bend in."""
DAMPING = 1e-9
"""Where joints can hardly make up for an error, or not at all."""


class Follower:
    """Takes an arm from pose to pose.

    Args:
        kinematics: Of the arm.
        posture: What is a good one.

    Attributes:
        posture: The same.
    """

    def __init__(self, kinematics: Kinematics, posture: Posture) -> None:
        self._kinematics, self.posture = kinematics, posture
        room = np.minimum(LIMIT_ROOM, (kinematics.upper - kinematics.lower) / 4.0)
        self._lower, self._upper = kinematics.lower + room, kinematics.upper - room

    def next(
        self, q: FloatArray, drift: FloatArray, target: Any, gripper: FloatArray, stride: int = 1
    ) -> tuple[FloatArray, FloatArray] | None:
        """Joint values for a pose near the one that ``q`` has, or None.

        Args:
            q: Joint values ``(dof,)``.
            drift: How far the joints moved for the sake of the posture on the way to ``q``, for each spacing ``(dof,)``.
            target: The pose, as the kinematics want it.
            gripper: The same seen from above ``(3,)``, in the shelf frame.
            stride: How many spacings of a path it is away.

        Returns:
            The joint values, and the drift on the way to them.
        """
        kinematics, begin = self._kinematics, q
        for step in range(STEPS):
            error, jacobian = kinematics.error(q, target)
            if step and float(error @ error) < REACHED**2:
                return (q, drift) if float(np.abs(q - begin).max()) < LONGEST_STEP * stride**0.5 else None
            move = least_squares(jacobian, error, DAMPING)
            if step == 0 and len(q) > 6:
                drift = self._drift(q, drift, jacobian, gripper, stride)
                move = move + stride * drift
            q = self._moved(q, move, jacobian, error)
        return None

    def improved(self, q: FloatArray, target: Any, gripper: FloatArray, times: int) -> FloatArray | None:
        """The posture after so many improvements with the gripper at one place, or None where it is lost."""
        drift = np.zeros(len(q))
        for _ in range(times):
            found = self.next(q, drift, target, gripper, HASTE)
            if found is None:
                return None
            q, drift = found
        return q

    def joints_at_limits(self, q: FloatArray) -> Sequence[int]:
        """Numbers of the joints that stand at a limit."""
        at = (q <= self._lower + 1e-6) | (q >= self._upper - 1e-6)
        return [int(row) for row in np.flatnonzero(at)]

    def _moved(self, q: FloatArray, move: FloatArray, jacobian: FloatArray, error: FloatArray) -> FloatArray:
        """After a move; joints that would leave their limits stop there, and the others do their work."""
        to = np.clip(q + move, self._lower, self._upper)
        stopped = to != q + move
        if not stopped.any():
            return to
        kept = np.where(stopped, to - q, 0.0)
        kept = kept + least_squares(np.where(stopped, 0.0, jacobian), error - jacobian @ kept, DAMPING)
        return np.asarray(np.clip(q + kept, self._lower, self._upper))

    def _drift(
        self, q: FloatArray, drift: FloatArray, jacobian: FloatArray, gripper: FloatArray, stride: int
    ) -> FloatArray:
        """A Gauss-Newton step ``(dof,)`` along the self-motion, in which the gripper stays, not far from the last one."""
        direction = np.linalg.svd(jacobian)[2][-1]
        residuals, slopes = self.posture.strain(q, direction, gripper)
        wanted = -float(residuals @ slopes) / (float(slopes @ slopes) + STIFFNESS) / stride
        last, change = float(drift @ direction), LONGEST_CHANGE * stride
        step = min(max(wanted, last - change, -LONGEST_DRIFT), last + change, LONGEST_DRIFT)
        return np.asarray(step * direction)
