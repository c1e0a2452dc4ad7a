"""Samples a joint trajectory at the control rate, and refuses one that the arm cannot follow from where it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.backends.articulated.world import ArticulatedWorld
from phframe.backends.contract import START_ANGLE, START_POSITION
from phframe.core import ArmModel, FloatArray, InputError, JointTrajectory, Phase, Trajectory

SPEED_SLACK = 1.02
"""Joints may be told to be this much faster than they are made for: samples round."""


@dataclass(frozen=True, slots=True, eq=False)
class JointCommands:
    """What the joints are told, one row for each control step.

    Attributes:
        controls: For arm and fingers, as the engine takes them, ``k``.
        phases: What the arm is doing during each control step, ``k``.
        tips: Where the fingertip is meant to be as each control step ends, x and y ``(k, 2)`` (m).
    """

    controls: Sequence[Any]
    phases: tuple[Phase, ...]
    tips: FloatArray


def commands(world: ArticulatedWorld, trajectory: JointTrajectory) -> JointCommands:
    """Sample a trajectory once in every control step."""
    engine, period = world.engine, world.engine.period
    times = np.arange(1, math.ceil(trajectory.duration / period - 1e-9) + 1) * period
    positions, velocities = trajectory.sample(times)
    gripper = trajectory.gripper
    openings = np.interp(times, gripper.times, gripper.openings)
    seen = times - engine.delay
    tips = [np.interp(seen, gripper.times, gripper.poses[:, axis]) for axis in (0, 1)]
    legs = np.searchsorted(gripper.times, times - period / 2.0, side="right") - 1
    phases = tuple(map(gripper.phases.__getitem__, np.minimum(legs, len(gripper.phases) - 1).tolist()))
    return JointCommands(
        engine.controls(positions, velocities, world.finger_values(openings)), phases, np.column_stack(tips)
    )


def accepted(world: ArticulatedWorld, trajectory: Trajectory) -> JointTrajectory:
    """The trajectory, if the arm can follow it from where it is.

    Raises:
        InputError: If it is not one of joints, of another arm, begins elsewhere, or is beyond a joint's limits.
    """
    if not isinstance(trajectory, JointTrajectory):
        raise InputError(
            f"the {world.engine.name} backend drives joints: it needs a JointTrajectory, as a motion planner makes them"
        )
    dof = len(world.arm.joints)
    if trajectory.positions.shape[1] != dof:
        raise InputError(f"a trajectory of {trajectory.positions.shape[1]} joints is not one of {dof}")
    _refuse_jump(world, trajectory)
    _refuse_excess(world.arm, trajectory)
    return trajectory


def _refuse_jump(world: ArticulatedWorld, trajectory: JointTrajectory) -> None:
    arm = world.engine.arm()
    x, y, yaw = (world.arm.gripper_pose(trajectory.positions[0], world.base_pose) - arm.gripper).tolist()
    distance, turn = math.hypot(x, y), abs(_wrapped(yaw))
    joints = float(np.abs(trajectory.positions[0] - arm.joints).max())
    if distance > START_POSITION or turn > START_ANGLE or joints > START_ANGLE:
        raise InputError(
            f"the trajectory begins {distance:.3f} m, {turn:.3f} rad and up to {joints:.3f} in a joint from where the arm is"
        )


def _wrapped(angle: float) -> float:
    return math.remainder(angle, math.tau)


def _refuse_excess(arm: ArmModel[Any], trajectory: JointTrajectory) -> None:
    spans = np.diff(trajectory.times)[:, None]
    steps = np.abs(np.diff(trajectory.positions, axis=0)) / np.where(spans > 0.0, spans, np.inf)
    for column, joint in enumerate(arm.joints):
        q = trajectory.positions[:, column]
        if q.min() < joint.lower - 1e-6 or q.max() > joint.upper + 1e-6:
            raise InputError(
                f"the trajectory takes joint {joint.name!r} from {q.min():.3f} to {q.max():.3f}; "
                f"its limits are {joint.lower:g} and {joint.upper:g}"
            )
        speed = max(np.abs(trajectory.velocities[:, column]).max(), steps[:, column].max(initial=0.0))
        if speed > joint.velocity * SPEED_SLACK:
            raise InputError(
                f"the trajectory moves joint {joint.name!r} at {speed:.3f}; its limit is {joint.velocity:g}"
            )
