"""An arm put into an MJCF text of a scene, with the servos that it has in the MuJoCo backend."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from phframe.backends.mujoco_.arm import PREFIX, arm_spec
from phframe.backends.mujoco_.options import MujocoOptions
from phframe.core import ArmModel, BasePose, IncompatibleError

HOME = "home"
"""Keyframe in which the arm is parked and every object stands at its place."""


def with_arm(mjcf: str, arm: ArmModel[Any], base_pose: BasePose) -> str:
    """The text with the arm at its base pose.

    Args:
        mjcf: A scene.
        arm: The arm.
        base_pose: Where its base stands in the world frame.

    Raises:
        IncompatibleError: If MuJoCo cannot load the arm.
    """
    robot = arm_spec(arm, MujocoOptions())
    spec = mujoco.MjSpec.from_string(mjcf)
    frame = spec.worldbody.add_frame(pos=base_pose.pose[:3], quat=base_pose.pose[3:])
    spec.attach(robot, prefix=PREFIX, frame=frame)
    try:
        model = spec.compile()
        _add_home(spec, model, arm)
        return str(spec.to_xml())
    except ValueError as error:
        raise IncompatibleError(f"MuJoCo cannot put {type(arm).__name__} into the scene: {error}") from None


def _add_home(spec: Any, model: Any, arm: ArmModel[Any]) -> None:
    """A keyframe; at joint values of 0 an arm may stand in the shelf."""
    positions, controls = np.array(model.qpos0), np.zeros(model.nu)
    values = [*arm.home, *(finger.lower for finger in arm.fingers.joints)]
    for joint, value in zip((*arm.joints, *arm.fingers.joints), values, strict=True):
        positions[int(model.joint(PREFIX + joint.name).qposadr[0])] = value
        controls[int(model.actuator(PREFIX + joint.name).id)] = value
    spec.add_key(name=HOME, qpos=positions, ctrl=controls)
