"""Time parametrisation: times for a path in joint space, as quick as joints, gripper and the path's rules allow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    GripperTrajectory,
    JointTrajectory,
    Phase,
    PhaseRule,
)
from phframe.motion.options import ArticulatedOptions
from phframe.motion.segments import Segment
from phframe.motion.toppra_ import TimedPath, time_optimal

UNBOUNDED = 1e3
"""Limit of what has no limit of its own: it comes along with what has."""
FASTEST_FINGERS = 0.2
"""Rate of the opening where no rule says (m/s)."""


class TimeParametrisation:
    """Times motions of one arm.

    Args:
        arm: The arm.
        base_pose: Where it stands.
        options: Speeds and accelerations.
    """

    def __init__(self, arm: ArmModel[Any], base_pose: BasePose, options: ArticulatedOptions) -> None:
        self._arm, self._base_pose, self._options = arm, base_pose, options
        self._joint_speeds = np.array([joint.velocity for joint in arm.joints]) * options.joint_speed
        self._finger_speed = 2.0 * min(joint.velocity for joint in arm.fingers.joints)

    def trajectory(self, segments: Sequence[Segment]) -> JointTrajectory:
        """The segments one after another, with a rest between them.

        Raises:
            ArmError: If one of them cannot be driven within the limits.
        """
        dof, done = len(self._arm.joints), [self._timed(segment) for segment in segments]
        starts = np.concatenate([[0.0], np.cumsum([part.times[-1] for part in done])])
        kept = [slice(1 if number else 0, None) for number in range(len(done))]
        times = [part.times[rows] + start for part, rows, start in zip(done, kept, starts, strict=False)]
        values = np.vstack([part.values[rows] for part, rows in zip(done, kept, strict=True)])
        speeds = np.vstack([part.speeds[rows] for part, rows in zip(done, kept, strict=True)])
        phases: list[Phase] = []
        for part, segment in zip(done, segments, strict=True):
            phases += [segment.phase] * (len(part.times) - 1)
        x, y, yaw, opening = values[:, dof : dof + 4].T
        gripper = GripperTrajectory(
            np.concatenate(times), np.column_stack([x, y, yaw]), opening, tuple(phases), self._arm.force_limit
        )
        return JointTrajectory(gripper, self._within_limits(values[:, :dof]), speeds[:, :dof])

    def _within_limits(self, joints: FloatArray) -> FloatArray:
        """Joint values ``(k, dof)`` of which no curve leads beyond a limit, unless that is where it begins."""
        lower, upper = np.array([[joint.lower, joint.upper] for joint in self._arm.joints]).T
        return np.asarray(np.clip(joints, np.minimum(lower, joints[0]), np.maximum(upper, joints[0])))

    def _timed(self, segment: Segment) -> TimedPath:
        """Joints, x, y, yaw, opening and way of the fingertip over time."""
        poses = segment.poses if segment.poses is not None else self._seen_from_above(segment.joints)
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))])
        path = np.column_stack([segment.joints, poses, segment.openings, way])
        return time_optimal(path, self._speeds(segment.rule), self._accelerations(segment.rule))

    def _seen_from_above(self, joints: FloatArray) -> FloatArray:
        seen = np.array([self._arm.gripper_pose(q, self._base_pose) for q in joints])
        seen[:, 2] = np.unwrap(seen[:, 2])
        return seen

    def _speeds(self, rule: PhaseRule | None) -> FloatArray:
        if rule is None:
            gripper = [UNBOUNDED, UNBOUNDED, UNBOUNDED, min(FASTEST_FINGERS, self._finger_speed), UNBOUNDED]
        else:
            fingers = min(rule.finger_speed, self._finger_speed)
            gripper = [UNBOUNDED, UNBOUNDED, rule.turn_speed, fingers, rule.speed]
        return np.concatenate([self._joint_speeds, gripper])

    def _accelerations(self, rule: PhaseRule | None) -> FloatArray:
        o = self._options
        along = UNBOUNDED if rule is None else o.gripper_acceleration
        gripper = [UNBOUNDED, UNBOUNDED, UNBOUNDED, o.finger_acceleration, along]
        return np.concatenate([np.full(len(self._joint_speeds), o.joint_acceleration), gripper])
