"""A MuJoCo world: the engine's data behind the abilities that every world of joints has."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import mujoco
import numpy as np

from phframe.backends.articulated.world import TOP_SPEED, JointWorld, Pair, Progress, Vector
from phframe.backends.mujoco_.model import Model
from phframe.backends.mujoco_.shelf import BOX, PLANE
from phframe.backends.mujoco_.warnings import caught_warnings
from phframe.core import FloatArray, State, planar_pose, yaw_of

AWAY = 10.0
"""What has spilled is put this far before the mouth (m), where it meets nothing."""
GRAVITY = 9.81


class World(JointWorld):
    """A world at some moment.

    Args:
        model: What it is an instance of.
        data: MuJoCo's.
    """

    engine = "mujoco"

    def __init__(self, model: Model, data: Any) -> None:
        super().__init__(model.scene, model.arm, model.base_pose, model.mj.opt.timestep)
        self.model, self.data = model, data
        self.delay = self.step  # a step leaves poses one step behind the joints
        self._ranges = model.mj.actuator_forcerange[: model.dof]
        self._warnings: list[str] = []
        self._step = self._stepping()
        self._tip, self._felt, self._told = (
            data.xpos[model.tip, :2],
            data.sensordata,
            data.ctrl,
        )  # the engine's own memory

    @property
    def joints(self) -> FloatArray:
        """Joint values ``(dof,)``."""
        return np.asarray(self.data.qpos[self.model.joints])

    @property
    def fingers(self) -> FloatArray:
        """What the two finger joints are ``(2,)``."""
        return np.asarray(self.data.qpos[self.model.fingers])

    @property
    def told_fingers(self) -> FloatArray:
        """What the two finger joints are told to be ``(2,)``."""
        return np.asarray(self.data.ctrl[self.model.dof :])

    @property
    def gripper(self) -> FloatArray:
        """Fingertip pose ``(3,)`` in the shelf frame."""
        mujoco.mj_kinematics(self.model.mj, self.data)  # a step leaves poses one step behind the joints
        pose = np.concatenate([self.data.xpos[self.model.tip], self.data.xquat[self.model.tip]])
        return np.array([pose[0], pose[1], yaw_of(pose)])

    @property
    def object_poses(self) -> FloatArray:
        """Pose of every object ``(n, 7)``."""
        return np.asarray(self.data.qpos[self.model.object_poses])

    @property
    def velocities(self) -> FloatArray:
        """Velocity of every object ``(n, 6)``, straight (m/s) and turning (rad/s)."""
        return np.asarray(self.data.qvel[self.model.moving])

    @property
    def inertias(self) -> FloatArray:
        """What each of the arm's joints has to accelerate ``(dof,)``, in the posture in which all joints are 0."""
        return np.asarray(self.model.mj.dof_M0[self.model.speeds])

    @property
    def given(self) -> FloatArray:
        """Magnitude of the force or torque that each of the arm's joints gave in the last step ``(dof,)``."""
        return np.asarray(np.abs(self.data.actuator_force[: self.model.dof]))

    @property
    def trouble(self) -> str | None:
        """What MuJoCo has warned of, or that the arm is nowhere."""
        if self._warnings:
            return self._warnings[0].strip()
        if not (np.isfinite(self.data.qpos).all() and np.isfinite(self.data.qvel).all()):
            return "the arm is nowhere; try a smaller backend step"
        return None

    def touching(self) -> Iterator[Pair]:
        """The arm's contacts with anything else, as geoms."""
        arm = self.model.is_arm
        for one, other in self.data.contact.geom.tolist():
            if arm[one] is not arm[other]:
                yield (one, other) if arm[one] else (other, one)

    def names(self, pair: Pair) -> tuple[str, str, bool]:
        """The part of the arm, what it touches, whether that is a wall."""
        part, thing = pair
        return self.model.names[part], self.model.names[thing], self.model.is_wall[thing]

    def pushes(self) -> Iterator[tuple[int, int, Vector]]:
        """Of every contact of a finger with an object: the object's row, the finger, its direction."""
        contact, sides, rows = self.data.contact, self.model.sides, self.model.rows
        for (one, other), (x, y, z) in zip(contact.geom.tolist(), contact.frame[:, :3].tolist(), strict=True):
            side, row = sides[one] or sides[other], rows[other] if sides[one] else rows[one]
            if side and row is not None:
                yield row, side, (x, y, z) if sides[one] else (-x, -y, -z)

    def controls(self, positions: FloatArray, velocities: FloatArray, fingers: FloatArray) -> list[Any]:
        """Joint values, leading where joints move, then the two fingers ``(dof + 2,)``, of ``k`` control steps."""
        return list(np.hstack([positions + self.model.lead * velocities, fingers]))

    def tell(self, control: Any) -> None:
        """Tell the servos where to be."""
        self._told[:] = control

    def hold_joints(self, positions: FloatArray) -> None:
        """Tell the arm to stand still at joint values ``(dof,)``."""
        self.data.ctrl[: self.model.dof] = positions

    def comply(self) -> None:
        """Ask nothing of the arm but to be where it is; its servos are springs with dampers."""
        self.hold_joints(self.joints)

    def cap(self, efforts: FloatArray) -> None:
        """Let the arm's joints give no more than this ``(dof,)`` (N or Nm)."""
        self._ranges[:, 0], self._ranges[:, 1] = -efforts, efforts

    def advance(self) -> Progress:
        """Let one control step pass. The hot path."""
        self._step()
        tip_x, tip_y = self._tip.tolist()
        touching, x, y, z = self._felt.tolist()
        return tip_x, tip_y, touching, math.hypot(x, y, z) if touching else 0.0

    def survey(self) -> None:
        """As every world, but with a quick look whether anything can have left the board at all."""
        self.refuse_divergence()
        if self.data.qpos.take(self.model.depths_and_heights).min() < 0.0:
            self.spill(self.object_poses)

    @contextmanager
    def running(self) -> Iterator[None]:
        """Collect what MuJoCo warns of."""
        self._step = self._stepping()
        with caught_warnings() as self._warnings:
            yield
        self._warnings = []

    def refuse_divergence(self) -> None:
        """Raise where numbers are not physical; look at them one by one only where some may not be."""
        qvel = self.data.qvel  # nothing that is not a number is less; all together are quicker to look at than each
        if self._warnings or not (qvel.dot(qvel) < TOP_SPEED**2 or np.abs(qvel).max() < TOP_SPEED):
            super().refuse_divergence()

    def _stepping(self) -> Callable[[], None]:
        return partial(mujoco.mj_step, self.model.mj, self.data, self.substeps)

    def _place(self, state: State, joints: FloatArray, fingers: FloatArray, told_fingers: FloatArray) -> None:
        model, data = self.model, self.data
        mujoco.mj_resetData(model.mj, data)
        data.qpos[model.object_poses] = state.poses
        for row in self.spilled:
            self._remove(row)
        data.qpos[model.joints] = data.ctrl[: model.dof] = joints
        data.qpos[model.fingers], data.ctrl[model.dof :] = fingers, told_fingers
        model.mj.geom_conaffinity[model.feet] = PLANE

    def _remove(self, row: int) -> None:
        """Put it far away, where it hangs still."""
        model, data = self.model, self.data
        data.qpos[model.object_poses[row]] = planar_pose(-AWAY - row, 0.0)
        data.qvel[model.moving[row]] = 0.0
        data.xfrc_applied[model.bodies[row], 2] = GRAVITY * model.scene.objects[row].mass

    def _stand(self, row: int, *, on_edge: bool) -> None:
        self.model.mj.geom_conaffinity[self.model.feet[row]] = BOX if on_edge else PLANE
