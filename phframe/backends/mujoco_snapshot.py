"""A MuJoCo world caught in motion, for planners that steer at control level."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from phframe.backends.mujoco_world import World, read_state, restore
from phframe.core import (
    ArmError,
    FloatArray,
    Floats,
    GripperTrajectory,
    JointTrajectory,
    Phase,
    State,
    Value,
    compose,
    inverse,
    planar_pose,
)

SAMPLE = 0.02
"""Seconds between joint samples."""
EVERYTHING = mujoco.mjtState.mjSTATE_INTEGRATION
"""All that the engine's next step depends on."""


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot(Value):
    """A state, and the engine's own account of it.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        engine: MuJoCo's integration state, speeds, commands and warm start included.
    """

    state: State
    engine: Floats

    def __post_init__(self) -> None:
        self._freeze("engine")


def take_snapshot(world: World) -> Snapshot:
    """The world as it is now."""
    mj, engine = world.model.mj, np.empty(mujoco.mj_stateSize(world.model.mj, EVERYTHING))
    state = read_state(world)
    mujoco.mj_getState(mj, world.data, engine, EVERYTHING)
    return Snapshot(state, engine)


def put_back(world: World, snapshot: Snapshot) -> None:
    """Make the world be what it was when the snapshot was taken."""
    restore(world, snapshot.state)
    mujoco.mj_setState(world.model.mj, world.data, snapshot.engine, EVERYTHING)


def held_twist(
    world: World, snapshot: Snapshot, twist: FloatArray, dt: float, opening: float | None
) -> JointTrajectory:
    """The trajectory of joints that keeps a fingertip twist ``(3,)`` for ``dt`` seconds.

    Raises:
        ArmError: If the arm has no joint values for a pose on the way.
    """
    arm = snapshot.state.arm
    assert arm is not None, "a snapshot with a parked arm is refused"
    assert arm.joints is not None, "a snapshot of this backend has joints"
    times = np.linspace(0.0, dt, max(2, round(dt / SAMPLE) + 1))
    poses = arm.gripper + times[:, None] * np.asarray(twist)
    told = arm.commanded_opening
    openings = np.linspace(told, told if opening is None else opening, len(times))
    limit = world.model.arm.force_limit
    gripper = GripperTrajectory(times, poses, openings, (Phase.SWEEP,) * (len(times) - 1), limit)
    joints = _followed(world, poses, arm.joints)
    return JointTrajectory(gripper, joints, np.gradient(joints, times, axis=0))


def _followed(world: World, poses: FloatArray, start: FloatArray) -> FloatArray:
    arm, base, found = world.model.arm, inverse(world.model.mount.pose), [start]
    for x, y, yaw in poses[1:]:
        q = arm.inverse(compose(base, planar_pose(x, y, arm.shape.height, yaw)), found[-1])
        if q is None:
            raise ArmError(f"the arm cannot have its fingertip at x {x:.3f} m, y {y:.3f} m, yaw {yaw:.2f} rad")
        found.append(q)
    return np.array(found)
