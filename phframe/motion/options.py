"""Options that all arms with a motion planner of joints share."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from phframe.core import Options


class ArticulatedOptions(Options):
    """How the arm moves.

    Attributes:
        motion_planner: Outside the shelf: a planner of OMPL, or BiEST.
        joint_speed: Fraction of the joints' greatest speeds that is made use of.
        joint_acceleration: Of every joint (rad/s^2 or m/s^2).
        gripper_acceleration: Of the fingertip along a path (m/s^2).
        finger_acceleration: Of the opening (m/s^2).
        search: Most iterations of the motion planner.
    """

    motion_planner: str = "RRTConnect"
    joint_speed: Annotated[float, Field(gt=0.0, le=1.0)] = 0.9
    joint_acceleration: Annotated[float, Field(gt=0.0, le=100.0)] = 6.0
    gripper_acceleration: Annotated[float, Field(gt=0.0, le=100.0)] = 3.0
    finger_acceleration: Annotated[float, Field(gt=0.0, le=100.0)] = 5.0
    search: Annotated[int, Field(ge=1, le=1_000_000)] = 20_000
