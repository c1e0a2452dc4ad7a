"""A planar arm: a two-fingered gripper ahead of a straight link, moved in x, y and yaw."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from phframe.core import (
    ArmError,
    ArmModel,
    ArmShape,
    BasePose,
    Fingers,
    FloatArray,
    Joint,
    Options,
    Outline,
    Scene,
    Shelf,
    planar_pose,
    yaw_of,
)
from phframe.motion.planar import PlanarMotionOptions, PlanarMotionPlanner
from phframe.urdf.planar import planar_robot
from phframe.urdf.writer import robot_urdf

HEIGHT = 0.06
"""Of the gripper plane above the board (m): half the height of the usual object."""
Length = Annotated[float, Field(gt=0.0, le=5.0)]


class PlanarArmOptions(Options):
    """Widths and lengths of the planar arm.

    Attributes:
        link_width: Width of the link (m).
        insertion_width: Width of the two closed fingers together (m).
        max_opening: Largest distance between the fingers (m).
        finger_length: How far the fingers stand out of the palm (m).
        palm_length: How far the palm stands out of the link (m).
        link_length: Length of the link behind the palm (m); longer than any shelf is deep.
    """

    link_width: Length = 0.12
    insertion_width: Length = 0.018
    max_opening: Length = 0.08
    finger_length: Length = 0.07
    palm_length: Length = 0.04
    link_length: Length = 1.2


class PlanarArm(ArmModel[PlanarArmOptions]):
    """Three joints that are the fingertip's x, y (m) and yaw (rad) in the frame of the base."""

    options_type = PlanarArmOptions

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Two sliding joints, x and y, and a turning one, yaw."""
        return (
            Joint("x", -1.0, 2.0, velocity=1.0, effort=200.0),
            Joint("y", -2.0, 2.0, velocity=1.0, effort=200.0),
            Joint("yaw", -math.pi, math.pi, velocity=2.0, effort=100.0),
        )

    @property
    def home(self) -> FloatArray:
        """All joints 0: the fingertip is at the base."""
        return np.zeros(3)

    @property
    def fingers(self) -> Fingers:
        """Two fingers that slide apart by half the opening each."""
        travel = self.options.max_opening / 2.0
        left, right = (Joint(f"{side}_finger", 0.0, travel, velocity=0.2, effort=20.0) for side in ("left", "right"))
        return Fingers((left, right), ("left_finger_link", "right_finger_link"))

    @cached_property
    def shape(self) -> ArmShape:
        """Two fingers, a palm as wide as the open fingers need, and the link."""
        o = self.options
        palm_width = o.max_opening + o.insertion_width
        palm_back = -o.finger_length - o.palm_length
        outlines = (
            _box("left finger", -o.finger_length, 0.0, 0.0, o.insertion_width / 2.0, side=1),
            _box("right finger", -o.finger_length, 0.0, -o.insertion_width / 2.0, 0.0, side=-1),
            _box("palm", palm_back, -o.finger_length, -palm_width / 2.0, palm_width / 2.0),
            _box("link", palm_back - o.link_length, palm_back, -o.link_width / 2.0, o.link_width / 2.0),
        )
        return ArmShape(outlines, max(o.link_width, palm_width), o.insertion_width, o.max_opening, height=HEIGHT)

    def forward(self, q: ArrayLike) -> FloatArray:
        """The joints are the pose."""
        values = np.asarray(q, dtype=np.float64)
        if values.shape != (3,) or not np.isfinite(values).all():
            raise ArmError(f"the planar arm needs three finite joint values (x, y, yaw), not {values.tolist()}")
        return planar_pose(values[0], values[1], 0.0, values[2])

    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        """The pose is the joints, if it lies in the plane and within limits."""
        target = np.asarray(pose, dtype=np.float64)
        if target.shape != (7,) or not np.isfinite(target).all():
            raise ArmError("a pose needs seven finite numbers: x y z, qw qx qy qz")
        q = np.array([target[0], target[1], yaw_of(target)])
        level = np.allclose(self.forward(q)[2:], _same_sign(target)[2:], atol=1e-9)
        return q if level and self.within_limits(q) else None

    def default_base_pose(self, shelf: Shelf) -> BasePose:
        """In front of the middle of the mouth."""
        return BasePose(-0.1, shelf.width / 2.0, HEIGHT, 0.0)

    def motion_planner(self, scene: Scene, base_pose: BasePose) -> PlanarMotionPlanner:
        """Straight from corner to corner."""
        return PlanarMotionPlanner(scene, self, base_pose, PlanarMotionOptions())

    def urdf(self) -> str:
        """Three joints, a box for each part of the outline, and a sliding joint for each finger."""
        return robot_urdf(planar_robot("planar", self.joints, self.fingers, self.shape.closed))


def _box(part: str, x0: float, x1: float, y0: float, y1: float, side: int = 0) -> Outline:
    return Outline(part, np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]), side)


def _same_sign(pose: FloatArray) -> FloatArray:
    """The same pose with a quaternion whose scalar part is not negative."""
    return np.concatenate([pose[:3], pose[3:] if pose[3] >= 0.0 else -pose[3:]])
