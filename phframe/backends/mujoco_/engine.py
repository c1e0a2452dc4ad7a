"""MuJoCo as an engine of joints: the compiled model and its data behind ``JointEngine``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import mujoco
import numpy as np

from phframe.backends.articulated import (
    ArmReading,
    ContactPair,
    EngineContact,
    ObjectReading,
    Placement,
    Progress,
    substeps,
)
from phframe.backends.mujoco_.model import build_model
from phframe.backends.mujoco_.options import MujocoOptions
from phframe.backends.mujoco_.shelf import BOARD, ENDING_BOARD, meets
from phframe.core import ArmModel, BasePose, FloatArray, Scene, planar_pose, seen_from_above
from phframe.core.scene import GRAVITY

AWAY = 10.0
"""What has spilled is put this far before the mouth (m), where it meets nothing."""
EVERYTHING = mujoco.mjtState.mjSTATE_INTEGRATION
"""All that the engine's next step depends on: speeds, commands and warm start included."""


class MujocoEngine:
    """A scene with an arm in MuJoCo.

    Args:
        scene: The scene.
        arm: The arm.
        base_pose: Of the arm.
        options: Of the backend.

    Attributes:
        model: The compiled model, and where in it everything is.
        data: MuJoCo's.

    Raises:
        IncompatibleError: If MuJoCo cannot have the arm.
    """

    name = "mujoco"

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: MujocoOptions) -> None:
        self.model = model = build_model(scene, arm, base_pose, options)
        self.data = data = mujoco.MjData(model.mj)
        self._substeps = substeps(options.step, options.control_period)
        self.period = self._substeps * options.step
        self.delay = options.step  # a step leaves poses one step behind the joints
        self._ranges = model.mj.actuator_forcerange[: model.dof]
        self._pairs: dict[tuple[int, int], ContactPair] = {}
        self._warnings: list[str] = []
        self._step = self._stepping()
        # The engine's own memory.
        self._tip, self._felt, self._told = data.xpos[model.tip, :2], data.sensordata, data.ctrl

    def place(self, placement: Placement) -> None:
        """Put everything in its place, warm starts and sleep forgotten."""
        model, data = self.model, self.data
        mujoco.mj_resetData(model.mj, data)
        data.qpos[model.object_poses] = placement.poses
        for row in placement.spilled:
            self.remove(row)
        data.qpos[model.joints] = data.ctrl[: model.dof] = placement.joints
        data.qpos[model.fingers], data.ctrl[model.dof :] = placement.fingers, placement.commanded_fingers
        for row in range(len(model.feet)):
            self.set_held(row, held=False)

    def arm(self) -> ArmReading:
        """The arm as it is now."""
        model, data = self.model, self.data
        mujoco.mj_kinematics(model.mj, data)  # a step leaves poses one step behind the joints
        return ArmReading(
            joints=data.qpos[model.joints],
            fingers=data.qpos[model.fingers],
            commanded_fingers=data.ctrl[model.dof :].copy(),
            gripper=seen_from_above(np.concatenate([data.xpos[model.tip], data.xquat[model.tip]])),
            efforts=np.abs(data.actuator_force[: model.dof]),
            inertias=model.mj.dof_M0[model.speeds],
        )

    def objects(self) -> ObjectReading:
        """The objects as they are now."""
        return ObjectReading(self.data.qpos.take(self.model.object_poses), self.data.qvel.take(self.model.moving))

    def contacts(self) -> Iterator[EngineContact]:
        """The arm's contacts with anything else, told by the bodies that geoms belong to."""
        is_arm, contact, pairs = self.model.is_arm, self.data.contact, self._pairs
        frames = contact.frame
        for number, (one, other) in enumerate(contact.geom.tolist()):
            if is_arm[one] is not is_arm[other]:
                geoms = (one, other) if is_arm[one] else (other, one)
                pair = pairs.get(geoms) or pairs.setdefault(geoms, self._pair(*geoms))
                x, y, z = frames[number, :3].tolist()
                yield pair, (x, y, z) if is_arm[one] else (-x, -y, -z)

    def _pair(self, part: int, body: int) -> ContactPair:
        model = self.model
        return ContactPair(
            model.names[part], model.names[body], model.is_wall[body], model.rows[body], model.sides[part]
        )

    def trouble(self) -> str | None:
        """What MuJoCo has warned of, or that the arm is nowhere."""
        if self._warnings:
            return self._warnings[0].strip()
        qpos, qvel = self.data.qpos, self.data.qvel
        if not (math.isfinite(qvel.dot(qvel)) and math.isfinite(qpos.dot(qpos))):
            return "the arm is nowhere; try a smaller backend step"
        return None

    def controls(self, positions: FloatArray, velocities: FloatArray, fingers: FloatArray) -> list[Any]:
        """Joint values, leading where joints move, then the two fingers ``(dof + 2,)``, of ``k`` control steps."""
        return list(np.hstack([positions + self.model.lead * velocities, fingers]))

    def command(self, control: Any) -> None:
        """Tell the servos where to be."""
        self._told[:] = control

    def cap(self, efforts: FloatArray) -> None:
        """Let the arm's joints give no more than this ``(dof,)`` (N or Nm)."""
        self._ranges[:, 0], self._ranges[:, 1] = -efforts, efforts

    def comply(self) -> None:
        """Tell the arm's servos to be where they are: they are springs with dampers."""
        self.data.ctrl[: self.model.dof] = self.data.qpos[self.model.joints]

    def advance(self) -> Progress:
        """Let one control step pass. The hot path."""
        self._step()
        tip_x, tip_y = self._tip.tolist()
        touching, x, y, z = self._felt.tolist()
        return tip_x, tip_y, touching, math.hypot(x, y, z) if touching else 0.0

    def remove(self, row: int) -> None:
        """Put an object far away, where it hangs still."""
        model, data = self.model, self.data
        data.qpos[model.object_poses[row]] = planar_pose(-AWAY - row, 0.0)
        data.qvel[model.moving[row]] = 0.0
        data.xfrc_applied[model.bodies[row], 2] = GRAVITY * model.scene.objects[row].mass

    def set_held(self, row: int, *, held: bool) -> None:
        """Let an object meet the boxes that are board and walls, which end at the mouth, or the planes."""
        model, meeting = self.model, self.model.mj.geom_conaffinity
        meeting[model.feet[row]] = ENDING_BOARD if held else BOARD
        meeting[model.hulls[row]] = meets(held=held)

    @contextmanager
    def running(self) -> Iterator[None]:
        """Collect what MuJoCo warns of, instead of lines on the screen and in a file ``MUJOCO_LOG.TXT``.

        The handler is the process's own, and is put back afterwards.
        """
        self._step, self._warnings = self._stepping(), []
        before = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(self._warnings.append)
        try:
            yield
        finally:
            mujoco.set_mju_user_warning(before)
            self._warnings = []

    def memory(self) -> FloatArray:
        """MuJoCo's integration state."""
        engine = np.empty(mujoco.mj_stateSize(self.model.mj, EVERYTHING))
        mujoco.mj_getState(self.model.mj, self.data, engine, EVERYTHING)
        return engine

    def recall(self, memory: FloatArray) -> None:
        """Take MuJoCo's integration state up again."""
        mujoco.mj_setState(self.model.mj, self.data, memory, EVERYTHING)

    def close(self) -> None:
        """Nothing to give back: the data goes with the engine."""

    def _stepping(self) -> Callable[[], None]:
        return partial(mujoco.mj_step, self.model.mj, self.data, self._substeps)
