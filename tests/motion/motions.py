"""Paths for arms that are given by a URDF, and what must be true of the motions that they are planned to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from phframe.core import (
    ArmModel,
    ArmState,
    BasePose,
    Contacts,
    Cylinder,
    FloatArray,
    GripperPath,
    GripperTrajectory,
    JointTrajectory,
    MotionPlanner,
    Phase,
    PhaseRule,
    Scene,
    SceneObject,
    Shelf,
    State,
    Unreachable,
    compose,
    motion_planner_of,
    tilt_of,
    yaw_of,
)
from phframe.registry import Kind, create

if TYPE_CHECKING:
    from phframe.arms.articulated import ArticulatedArm

SHELF = Shelf(depth=0.55, width=0.61)
MIDDLE = 0.305
BEFORE = -0.05
"""x of the fingertip before the mouth (m)."""
DEEP = 0.05
"""Where the fingertip is deeper (m), the gripper keeps to the path."""
TURNED = math.radians(15.0)
"""How far it may be turned against the path there (rad)."""


def cylinder(name: str, x: float, y: float) -> SceneObject:
    return SceneObject(name, Cylinder(0.03), (x, y))


EMPTY = Scene("lone", SHELF, (cylinder("target", 0.50, 0.06),), "target")
"""A shelf whose target is out of the way of all but what is meant for it."""


CROWD = Scene(
    "crowd",
    SHELF,
    (cylinder("left", 0.25, MIDDLE + 0.19), cylinder("right", 0.3, MIDDLE - 0.17), cylinder("target", 0.4, MIDDLE)),
    "target",
)


def baxter(side: str = "left") -> ArticulatedArm[Any]:
    arm: ArticulatedArm[Any] = _made("baxter", side)
    return arm


def example() -> ArticulatedArm[Any]:
    """Six joints: no self-motion."""
    arm: ArticulatedArm[Any] = _made("articulated", "")
    return arm


@cache
def _made(name: str, side: str) -> Any:
    return create(Kind.ARM, name, {"side": side} if side else {})


def planner(arm: ArmModel[Any], scene: Scene = EMPTY, base_pose: BasePose | None = None) -> MotionPlanner[Any]:
    return motion_planner_of(arm, scene, arm.default_base_pose(scene.shelf) if base_pose is None else base_pose)


def planned(
    planner: MotionPlanner[Any], path: GripperPath, state: State | None = None, seed: int = 0
) -> JointTrajectory | Unreachable:
    start = planner.scene.initial_state() if state is None else state
    return planner.plan(path, start, attempts=10, seconds=30.0, rng=np.random.default_rng(seed))


def path_of(
    arm: ArmModel[Any],
    legs: Sequence[tuple[Phase, Contacts, float, FloatArray]],
    begin: Any,
    manipuland: str | None = None,
) -> GripperPath:
    """From a pose along legs of phase, contacts, fraction of the opening and end."""
    shape = arm.shape
    rules = {
        phase: PhaseRule(0.2, shape.min_opening + fraction * (shape.max_opening - shape.min_opening), contacts)
        for phase, contacts, fraction, _ in legs
    }
    poses = np.vstack([begin, *(end for *_, end in legs)])
    return GripperPath(poses, tuple(phase for phase, *_ in legs), rules, manipuland)


def insertion(arm: ArmModel[Any], x: float, y: float, yaw: float = 0.0) -> GripperPath:
    """Straight in along a yaw (rad), and back."""
    inside, outside = np.array([x, y, yaw]), np.array([BEFORE, y - (x - BEFORE) * math.tan(yaw), yaw])
    legs = [(Phase.INSERT, Contacts.OBJECTS, 0.0, inside), (Phase.RETREAT, Contacts.OBJECTS, 0.0, outside)]
    return path_of(arm, legs, outside)


def sweep(arm: ArmModel[Any], x: float, y0: float, y1: float) -> GripperPath:
    """In at ``y0``, across to ``y1`` and out there."""
    legs = [
        (Phase.INSERT, Contacts.OBJECTS, 0.0, np.array([x, y0, 0.0])),
        (Phase.SWEEP, Contacts.OBJECTS, 0.0, np.array([x, y1, 0.0])),
        (Phase.RETREAT, Contacts.OBJECTS, 0.0, np.array([BEFORE, y1, 0.0])),
    ]
    return path_of(arm, legs, np.array([BEFORE, y0, 0.0]))


def grasp(arm: ArmModel[Any], x: float, y: float) -> GripperPath:
    """In with open fingers, close on the target, and out."""
    at = np.array([x, y, 0.0])
    legs = [
        (Phase.REACH, Contacts.MANIPULAND, 0.9, at),
        (Phase.GRASP, Contacts.MANIPULAND, 0.1, at),
        (Phase.WITHDRAW, Contacts.MANIPULAND, 0.1, np.array([-0.12, y, 0.0])),
    ]
    return path_of(arm, legs, np.array([BEFORE, y, 0.0]), EMPTY.target)


def seen(motion: JointTrajectory, planner: MotionPlanner[Any], times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """At times ``(k,)``: fingertip x, y, z and yaw ``(k, 4)``, and the tilt of its axes ``(k, 2)`` (rad)."""
    found, level = [], []
    for q in motion.sample(times)[0]:
        pose = compose(planner.base_pose.pose, planner.arm.forward(q))
        found.append([*pose[:3], yaw_of(pose)])
        w, x, y, z = pose[3:]
        level.append([tilt_of(pose), 2.0 * (x * z - w * y)])
    return np.array(found), np.array(level)


def off_the_path(points: FloatArray, path: GripperPath) -> tuple[FloatArray, FloatArray]:
    """How far points ``(k, >=4)`` x, y, z, yaw are from a path (m), and the least turn against it there (rad)."""
    distances, turns = [], []
    for a, b in zip(path.poses[:-1], path.poses[1:], strict=True):
        step = b[:2] - a[:2]
        square = float(step @ step)
        fraction = np.clip((points[:, :2] - a[:2]) @ step / square, 0.0, 1.0) if square else np.zeros(len(points))
        distances.append(np.hypot(*(points[:, :2] - a[:2] - fraction[:, None] * step).T))
        turns.append(np.abs(points[:, 3] - a[2] - fraction * (b[2] - a[2])))
    nearest = np.argmin(distances, axis=0)
    rows = np.arange(len(points))
    return np.array(distances)[nearest, rows], np.array(turns)[nearest, rows]


def paths(arm: Any) -> dict[str, GripperPath]:
    return {
        "straight": insertion(arm, 0.45, MIDDLE + 0.08),
        "sweep": sweep(arm, 0.3, MIDDLE - 0.1, MIDDLE + 0.12),
        "angled": insertion(arm, 0.35, MIDDLE - 0.13, math.radians(-25.0)),
        "grasp": grasp(arm, 0.4, MIDDLE),
    }


def arm_state(planner: MotionPlanner[Any], q: FloatArray, **more: Any) -> ArmState:
    point = seen_at(planner, q)
    return ArmState(point[[0, 1, 3]], planner.arm.shape.min_opening, joints=q, **more)


def seen_at(planner: MotionPlanner[Any], q: FloatArray) -> FloatArray:
    still = JointTrajectory(
        GripperTrajectory(np.array([0.0, 1.0]), np.zeros((2, 3)), np.zeros(2), (Phase.SWEEP,), 1.0),
        np.array([q, q]),
        np.zeros((2, len(q))),
    )
    points, _ = seen(still, planner, np.zeros(1))
    return np.asarray(points[0])


def halfway(planner: MotionPlanner[Any], path: GripperPath, x: float) -> FloatArray:
    """Joint values ``(dof,)`` of the motion along a path as the fingertip first is at a depth (m)."""
    motion = planned(planner, path)
    assert isinstance(motion, JointTrajectory)
    row = int(np.argmax(motion.gripper.poses[:, 0] >= x))
    return np.array(motion.positions[row])


def bits(motion: JointTrajectory | Unreachable) -> bytes:
    assert isinstance(motion, JointTrajectory), motion
    gripper = motion.gripper
    arrays = (motion.positions, motion.velocities, gripper.times, gripper.poses, gripper.openings)
    return b"".join(array.tobytes() for array in arrays)
