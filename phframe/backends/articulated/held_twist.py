"""What planners that steer at control level ask of a world of joints: hold a twist of the fingertip for a while."""

from __future__ import annotations

import numpy as np

from phframe.backends.articulated.world import JointWorld
from phframe.core import (
    ArmError,
    ArmState,
    FloatArray,
    GripperTrajectory,
    JointTrajectory,
    Phase,
    compose,
    inverse,
    planar_pose,
)

SAMPLE = 0.02
"""Seconds between joint samples."""


def held_twist(
    world: JointWorld, arm: ArmState, twist: FloatArray, dt: float, opening: float | None
) -> JointTrajectory:
    """The trajectory of joints that keeps a fingertip twist ``(3,)`` for ``dt`` seconds.

    Raises:
        ArmError: If the arm has no joint values for a pose on the way.
    """
    assert arm.joints is not None, "a snapshot of a world of joints has them"
    times = np.linspace(0.0, dt, max(2, round(dt / SAMPLE) + 1))
    poses = arm.gripper + times[:, None] * np.asarray(twist)
    told = arm.commanded_opening
    openings = np.linspace(told, told if opening is None else opening, len(times))
    limit = world.arm.force_limit
    gripper = GripperTrajectory(times, poses, openings, (Phase.SWEEP,) * (len(times) - 1), limit)
    joints = _followed(world, poses, arm.joints)
    return JointTrajectory(gripper, joints, np.gradient(joints, times, axis=0))


def _followed(world: JointWorld, poses: FloatArray, start: FloatArray) -> FloatArray:
    arm, base, found = world.arm, inverse(world.base_pose.pose), [start]
    for x, y, yaw in poses[1:]:
        q = arm.inverse(compose(base, planar_pose(x, y, arm.shape.height, yaw)), found[-1])
        if q is None:
            raise ArmError(f"the arm cannot have its fingertip at x {x:.3f} m, y {y:.3f} m, yaw {yaw:.2f} rad")
        found.append(q)
    return np.array(found)
