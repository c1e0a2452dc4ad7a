"""Options that all arms with a motion planner of joints share."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from phframe.core import BasePose, Options
from phframe.core.scene_check import base_pose_faults

Acceleration = Annotated[float, Field(gt=0.0, le=100.0)]
Margin = Annotated[float, Field(ge=0.0, le=0.05)]


AUTO: Literal["auto"] = "auto"


def _read(given: Any) -> Any:
    """Figures from their text, as the command line has them: ``[-0.7,0.3,-0.15,0]``."""
    if isinstance(given, str) and given != AUTO:
        return [figure.strip() for figure in given.strip("[]()").split(",")]
    return given


def _near(figures: Figures) -> Figures:
    for fault in base_pose_faults("a base pose", BasePose(*figures)):
        raise ValueError(fault)
    return figures


Figures = tuple[float, float, float, float]
Mounting = Annotated[Annotated[Figures, AfterValidator(_near)] | Literal["auto"] | None, BeforeValidator(_read)]


class ArticulatedOptions(Options):
    """How the arm moves.

    Attributes:
        motion_planner: Outside the shelf: a planner of OMPL, or BiEST.
        joint_speed: Fraction of the joints' greatest speeds that is made use of.
        joint_acceleration: Of every joint (rad/s^2 or m/s^2).
        gripper_acceleration: Of the fingertip along a path (m/s^2).
        finger_acceleration: Of the opening (m/s^2).
        search: Most iterations of the motion planner for one action; each of its searches has half of what is left.
        wall_margin: Distance kept between the arm and the shelf (m).
        object_margin: Distance kept between the arm and objects that it must not touch (m).
        cartesian_spacing: Between the poses of a path for which joints are found and checked for collisions (m).
        yaw_tolerance: Most by which the gripper is turned against a path in the shelf, where it cannot be followed
            otherwise (rad).
        mount: Where the base stands in the shelf frame: x, y, z (m), yaw (rad); or ``auto``: as near the default as it can
            be and get at the scene's target. None: as the scene says, else where the arm has it by default.
    """

    motion_planner: str = "RRTConnect"
    joint_speed: Annotated[float, Field(gt=0.0, le=1.0)] = 0.9
    joint_acceleration: Acceleration = 6.0
    gripper_acceleration: Acceleration = 3.0
    finger_acceleration: Acceleration = 5.0
    search: Annotated[int, Field(ge=1, le=1_000_000)] = 20_000
    wall_margin: Margin = 0.0015
    object_margin: Margin = 0.001
    cartesian_spacing: Annotated[float, Field(ge=0.001, le=0.02)] = 0.005
    yaw_tolerance: Annotated[float, Field(ge=0.0, le=0.8)] = math.radians(15.0)
    mount: Mounting = None

    @property
    def base_pose(self) -> BasePose | None:
        """The mount, where it is given by its figures."""
        return BasePose(*self.mount) if isinstance(self.mount, tuple) else None
