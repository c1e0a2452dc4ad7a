"""A MuJoCo world: the engine's data, and what the engine does not know, such as what has spilled and what is held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from phframe.backends.mujoco_model import Model
from phframe.backends.mujoco_shelf import BOX, PLANE
from phframe.core import (
    ArmState,
    Condition,
    FloatArray,
    InputError,
    SimulationDivergedError,
    State,
    compose,
    condition_of,
    inverse,
    planar_pose,
    refuse_foreign,
    yaw_of,
)

TOP_SPEED = 20.0
"""Anything faster (m/s) is not physics any more."""
AWAY = 10.0
"""What has spilled is put this far before the mouth (m), where it meets nothing."""
GRAVITY = 9.81


@dataclass(slots=True)
class World:
    """A world at some moment.

    Attributes:
        model: What it is an instance of.
        data: MuJoCo's.
        spilled: Last pose seen, by row of the object.
        held: Row of the object in the hand.
        parked: The arm stands at home and has not been used yet.
    """

    model: Model
    data: Any
    spilled: dict[int, FloatArray] = field(default_factory=dict)
    held: int | None = None
    parked: bool = True

    @property
    def joints(self) -> FloatArray:
        """Joint values ``(dof,)``."""
        return np.asarray(self.data.qpos[self.model.joints])

    @property
    def opening(self) -> float:
        """Distance between the fingers (m)."""
        return self.model.arm.shape.min_opening + float((self.data.qpos[self.model.fingers] - self.model.closed).sum())

    @property
    def command(self) -> float:
        """The distance between the fingers that they are told to have (m)."""
        told = self.data.ctrl[self.model.dof :] - self.model.closed
        return self.model.arm.shape.min_opening + float(told.sum())

    @property
    def gripper(self) -> FloatArray:
        """Fingertip pose ``(3,)`` in the shelf frame."""
        mujoco.mj_kinematics(self.model.mj, self.data)  # a step leaves poses one step behind the joints
        pose = np.concatenate([self.data.xpos[self.model.tip], self.data.xquat[self.model.tip]])
        return np.array([pose[0], pose[1], yaw_of(pose)])

    @property
    def speeds(self) -> FloatArray:
        """Speed of every object ``(n,)``, that of its rim included (m/s); 0 of what has spilled."""
        velocity = self.data.qvel[self.model.moving]
        turning = np.linalg.norm(velocity[:, 3:], axis=1) * self.model.scene.radii
        speeds = np.linalg.norm(velocity[:, :3], axis=1) + turning
        speeds[list(self.spilled)] = 0.0
        return np.asarray(speeds)


def finger_values(model: Model, openings: ArrayLike) -> FloatArray:
    """What the two finger joints are ``(..., 2)`` at openings ``(...)`` (m)."""
    travel = (np.asarray(openings) - model.arm.shape.min_opening) / 2.0
    return np.asarray(model.closed + travel[..., None])


def restore(world: World, state: State) -> None:
    """Make the world be a state, at rest.

    Raises:
        InputError: If the state is not one of this scene and this arm.
    """
    refuse_foreign(world.model.scene, world.model.arm.shape, state)
    joints = _joints_of(world.model, state.arm)
    model, data = world.model, world.data
    mujoco.mj_resetData(model.mj, data)
    data.qpos[model.lying] = state.poses
    world.spilled = {}
    for row in np.flatnonzero(~state.on_board):
        _take_out(world, int(row), state.poses[row])
    shape = model.arm.shape
    opening, command = (
        (shape.min_opening, shape.min_opening)
        if state.arm is None
        else (state.arm.opening, state.arm.commanded_opening)
    )
    data.qpos[model.joints] = data.ctrl[: model.dof] = joints
    data.qpos[model.fingers], data.ctrl[model.dof :] = finger_values(model, opening), finger_values(model, command)
    model.mj.geom_conaffinity[model.feet] = PLANE
    world.held = None
    hold(world, None if state.held is None else model.scene.index(state.held))
    world.parked = state.arm is None


def hold(world: World, row: int | None) -> None:
    """Note what is held; what is held stands on a board that ends at the mouth, all else on a plane."""
    model, mj = world.model, world.model.mj
    for known, bits in ((world.held, PLANE), (row, BOX)):
        if known is not None:
            mj.geom_conaffinity[model.feet[known]] = bits
    world.held = row


def _joints_of(model: Model, arm: ArmState | None) -> FloatArray:
    if arm is None:
        return np.asarray(model.arm.home)
    if arm.joints is not None:
        if arm.joints.shape != (model.dof,):
            raise InputError(f"a state's arm has {len(arm.joints)} joints, this one {model.dof}")
        return arm.joints
    x, y, yaw = (float(value) for value in arm.gripper)
    wanted = planar_pose(x, y, model.arm.shape.height, yaw)
    found = model.arm.inverse(compose(inverse(model.mount.pose), wanted))
    if found is None:
        raise InputError(f"the arm cannot have its fingertip at x {x:.3f} m, y {y:.3f} m, yaw {yaw:.2f} rad")
    return found


def _take_out(world: World, row: int, pose: FloatArray) -> None:
    """Put what has spilled far away, where it hangs still, and keep the pose it was last seen at."""
    model, data = world.model, world.data
    world.spilled[row] = np.array(pose)
    data.qpos[model.lying[row]] = planar_pose(-AWAY - row, 0.0)
    data.qvel[model.moving[row]] = 0.0
    data.xfrc_applied[model.bodies[row], 2] = GRAVITY * model.scene.objects[row].mass


def spill(world: World) -> None:
    """Take out what has left the board."""
    if world.data.qpos.take(world.model.depths_and_heights).min() >= 0.0:
        return
    lying = world.data.qpos[world.model.lying]
    for row in np.flatnonzero((lying[:, 0] < 0.0) | (lying[:, 2] < 0.0)):
        held = row == world.held
        if row not in world.spilled and condition_of(lying[row], held=held) is Condition.SPILLED:
            _take_out(world, int(row), lying[row])


def refuse_divergence(world: World, warnings: Sequence[str]) -> None:
    """Raise where a body is nowhere or faster than physics allows, or MuJoCo has warned.

    Raises:
        SimulationDivergedError: With the object and its speed, or the warning.
    """
    data = world.data
    qvel = data.qvel  # nothing that is not a number is less; all together are quicker to look at than each
    if (qvel.dot(qvel) < TOP_SPEED**2 or np.abs(qvel).max() < TOP_SPEED) and not warnings:
        return
    speeds = world.speeds
    if not (speeds < TOP_SPEED).all():
        row = int(np.flatnonzero(~(speeds < TOP_SPEED))[0])
        what = f"{world.model.scene.ids[row]!r} moves at {speeds[row]:.3g} m/s"
        raise SimulationDivergedError(f"the simulation diverged: {what}; try a smaller backend step")
    if warnings:
        raise SimulationDivergedError(f"the simulation diverged: {warnings[0].strip()}")
    if not (np.isfinite(data.qpos).all() and np.isfinite(data.qvel).all()):
        raise SimulationDivergedError("the simulation diverged: the arm is nowhere; try a smaller backend step")


def read_state(world: World) -> State:
    """The world as it is now."""
    scene, poses = world.model.scene, np.array(world.data.qpos[world.model.lying])
    conditions = [condition_of(pose, held=row == world.held) for row, pose in enumerate(poses)]
    for row, pose in world.spilled.items():
        poses[row], conditions[row] = pose, Condition.SPILLED
    held = None if world.held is None else scene.ids[world.held]
    return State(poses, tuple(conditions), held, None if world.parked else _arm_state(world))


def _arm_state(world: World) -> ArmState:
    return ArmState(world.gripper, world.opening, world.command, world.joints)
