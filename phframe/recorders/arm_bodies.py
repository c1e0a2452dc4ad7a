"""The arm as bodies that move: the links of the robot where its joints are known, else its outlines made solid."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from phframe.core import ArmShape, ArmState, FloatArray, Outline, Scene, compose, planar_pose, yaw_of
from phframe.recorders import palette
from phframe.recorders.bodies import Body, Piece, prism
from phframe.recorders.frames import Frames, parked_arm
from phframe.recorders.robot import drawn_robot
from phframe.runtime.observer import MountedArm


class ArmBodies(ABC):
    """What is drawn of an arm, and where.

    Attributes:
        bodies: What is drawn.
        parked: Where the arm is when a state does not say.
    """

    bodies: tuple[Body, ...]
    parked: ArmState

    @abstractmethod
    def poses(self, frames: Frames) -> dict[str, FloatArray]:
        """Pose ``(m, 7)`` of every body in the shelf frame in ``m`` frames, by name; ``m`` is 1 for what never moves."""


def bodies_of(arm: MountedArm, scene: Scene) -> ArmBodies:
    """The arm of an episode.

    Raises:
        ArmError: If its URDF cannot be read.
    """
    return Links(arm) if arm.by_joints else Outlines(arm.shape, scene)


@dataclass(frozen=True, slots=True)
class _Joints:
    """The names of an arm's joints, and where the fingers are when they are closed."""

    arm: tuple[str, ...]
    fingers: tuple[str, str]
    closed: tuple[float, float]


class Links(ArmBodies):
    """The robot, joint by joint, on its base pose."""

    def __init__(self, arm: MountedArm) -> None:
        model = arm.model
        left, right = model.fingers.joints
        self._joints = _Joints(tuple(j.name for j in model.joints), (left.name, right.name), (left.lower, right.lower))
        self._robot = drawn_robot(model.urdf(), model.meshes(), model.fingers.links)
        self._base_pose, self._min_opening = arm.base_pose.pose, arm.shape.min_opening
        tip = compose(self._base_pose, model.forward(model.home))
        self.bodies = self._robot.bodies
        self.parked = ArmState(
            np.array([tip[0], tip[1], yaw_of(tip)]), arm.shape.min_opening, joints=np.array(model.home)
        )

    def poses(self, frames: Frames) -> dict[str, FloatArray]:
        """By the URDF's kinematics."""
        arms = [state.arm or self.parked for state in frames.states]
        joints = np.array([self.parked.joints if arm.joints is None else arm.joints for arm in arms], dtype=np.float64)
        values = dict(zip(self._joints.arm, joints.T, strict=True))
        travel = (frames.openings - self._min_opening) / 2.0
        values |= {
            name: closed + travel for name, closed in zip(self._joints.fingers, self._joints.closed, strict=True)
        }
        poses = self._robot.poses(self._base_pose, values)
        return {body.name: poses[body.name] for body in self.bodies}


class Outlines(ArmBodies):
    """The outlines made solid, at the height of the gripper plane."""

    def __init__(self, shape: ArmShape, scene: Scene) -> None:
        self._shape, self._sides = shape, {outline.part: outline.side for outline in shape.closed}
        self.bodies = tuple(_solid(part, outlines) for part, outlines in parts_of(shape).items())
        self.parked = parked_arm(scene, shape)

    def poses(self, frames: Frames) -> dict[str, FloatArray]:
        """Where the gripper is; fingers aside by half the opening."""
        opened = (frames.openings - self._shape.min_opening) / 2.0
        return {
            part: np.array([self._pose(at, side * out) for at, out in zip(frames.grippers, opened, strict=True)])
            for part, side in self._sides.items()
        }

    def _pose(self, gripper: FloatArray, aside: float) -> FloatArray:
        x, y, yaw = gripper
        return planar_pose(x - aside * np.sin(yaw), y + aside * np.cos(yaw), self._shape.height, yaw)


def parts_of(shape: ArmShape) -> dict[str, list[Outline]]:
    """The outlines, fingers closed, by the part that they are of: one that is not convex has several."""
    parts: dict[str, list[Outline]] = {}
    for outline in shape.closed:
        parts.setdefault(outline.part, []).append(outline)
    return parts


def _solid(part: str, outlines: list[Outline]) -> Body:
    color = palette.FINGER if outlines[0].side else palette.LINK
    return Body(part, tuple(Piece(str(number), prism(outline), color) for number, outline in enumerate(outlines)))
