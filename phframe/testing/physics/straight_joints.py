"""Joint trajectories by inverse kinematics alone, for backends that execute those, in free space."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    GripperTrajectory,
    InputError,
    JointTrajectory,
    Phase,
    State,
    compose,
    inverse,
    planar_pose,
    yaw_of,
)

SAMPLE = 0.02
"""Seconds between joint samples."""
HURRY = 0.5
"""Fraction of a joint's speed limit at which it moves to the beginning."""


def plan_straight(
    trajectory: GripperTrajectory, state: State, arm: ArmModel[Any], base_pose: BasePose
) -> JointTrajectory:
    """Joints straight from where they are to the beginning, then along the trajectory by inverse kinematics.

    It looks at no obstacle: what stands before the mouth of the test scenes is nothing.

    Raises:
        InputError: If the arm cannot reach a pose, or not as fast.
    """
    start = _joints(state, arm, base_pose)
    times = _sample_times(trajectory)
    gripper = np.array([trajectory.at(time)[0] for time in times])
    joints = _follow(gripper, start, arm, base_pose)
    approach = _approach(start, joints[0], arm)
    positions = np.vstack([approach[:-1], joints])
    lead = _lead_times(approach)
    all_times = np.concatenate([lead[:-1], times + lead[-1]])
    seen = [_seen_from_above(q, arm, base_pose) for q in approach[:-1]]
    _refuse_hurry(times, joints, arm)
    openings = np.array([trajectory.at(time)[1] for time in times])
    phases = [Phase.APPROACH] * (len(approach) - 1) + [trajectory.phase_at((a + b) / 2) for a, b in pairwise(times)]
    followed = GripperTrajectory(
        all_times,
        np.array([*seen, *gripper]),
        np.concatenate([np.full(len(approach) - 1, openings[0]), openings]),
        tuple(phases),
        trajectory.force_limit,
    )
    return JointTrajectory(followed, positions, _speeds(all_times, positions))


def _joints(state: State, arm: ArmModel[Any], base_pose: BasePose) -> FloatArray:
    if state.arm is None:
        return np.asarray(arm.home)
    if state.arm.joints is not None:
        return state.arm.joints
    return np.asarray(_follow(state.arm.gripper[None], np.asarray(arm.home), arm, base_pose)[0])


def _refuse_hurry(times: FloatArray, joints: FloatArray, arm: ArmModel[Any]) -> None:
    """Refuse what no joint can be as fast as."""
    speeds = np.abs(np.diff(joints, axis=0)) / np.maximum(np.diff(times), 1e-9)[:, None]
    fastest = speeds.max(axis=0, initial=0.0)
    for joint, speed in zip(arm.joints, fastest.tolist(), strict=True):
        if speed > joint.velocity:
            raise InputError(f"{joint.name} would have to move at {speed:.2f}, and its limit is {joint.velocity:g}")


def _sample_times(trajectory: GripperTrajectory) -> FloatArray:
    even = np.linspace(0.0, trajectory.duration, max(2, int(np.ceil(trajectory.duration / SAMPLE)) + 1))
    return np.unique(np.concatenate([even, trajectory.times]))


def _follow(gripper: FloatArray, seed: FloatArray, arm: ArmModel[Any], base_pose: BasePose) -> FloatArray:
    base = inverse(base_pose.pose)
    found: list[FloatArray] = []
    for x, y, yaw in gripper:
        q = arm.inverse(compose(base, planar_pose(x, y, arm.shape.height, yaw)), found[-1] if found else seed)
        if q is None:
            raise InputError(f"there are no joint values for the fingertip at x {x:.3f}, y {y:.3f}, yaw {yaw:.2f}")
        found.append(q)
    return np.array(found)


def _approach(start: FloatArray, end: FloatArray, arm: ArmModel[Any]) -> FloatArray:
    speeds = np.array([joint.velocity for joint in arm.joints])
    seconds = float((np.abs(end - start) / speeds).max()) / HURRY
    return np.asarray(np.linspace(start, end, max(1, int(np.ceil(seconds / SAMPLE))) + 1), dtype=np.float64)


def _lead_times(approach: FloatArray) -> FloatArray:
    still = (approach[0] == approach[-1]).all()
    return np.asarray(np.arange(len(approach)) * (0.0 if still else SAMPLE), dtype=np.float64)


def _seen_from_above(q: FloatArray, arm: ArmModel[Any], base_pose: BasePose) -> FloatArray:
    tip = compose(base_pose.pose, arm.forward(q))
    return np.array([tip[0], tip[1], yaw_of(tip)])


def _speeds(times: FloatArray, positions: FloatArray) -> FloatArray:
    """Central differences, one-sided ones at the ends: a path that ends at full speed is not hurried at its end."""
    before, after = np.maximum(np.arange(len(times)) - 1, 0), np.minimum(np.arange(len(times)) + 1, len(times) - 1)
    spans = (times[after] - times[before])[:, None]
    return np.asarray((positions[after] - positions[before]) / np.where(spans > 0.0, spans, np.inf))
