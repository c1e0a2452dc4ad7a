"""The straight way in: the path of a gripper through the mouth of a shelf to a place, along its own yaw."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from phframe.core import MOUTH_CLEARANCE, Contacts, GripperPath, Phase, PhaseRule, Unreachable
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.geometry.arm_view import ArmView

YAWS = tuple(math.radians(degrees) for degrees in (0, 10, -10, 20, -20, 30, -30, 40, -40))
"""Of the gripper (rad), tried in this order."""
BOTH = Phase.REACH, Phase.WITHDRAW


def straight_way(
    view: ArmView, place: Sequence[float], yaw: float, opening: float, *, back: bool = False
) -> GripperPath | Unreachable:
    """The straight path from before the mouth to a place, or where a wall is in its way.

    Args:
        view: The arm between the walls.
        place: Where the fingertip is to be: x, y in the shelf frame (m).
        yaw: Of the gripper (rad).
        opening: Distance between the fingers (m).
        back: Whether the path goes back to where it began.
    """
    degrees, ahead = math.degrees(yaw), np.array([math.cos(yaw), math.sin(yaw)])
    if ahead[0] < LEAST_AHEAD:
        return Unreachable(0.0, f"the gripper does not come in through the mouth turned by {degrees:.0f} degrees", 0)
    tip, length = np.array(place, dtype=np.float64), way_length(view, place, yaw)
    travel = float(view.walls(yaw).travel(tip - length * ahead, ahead, length))
    if travel < length:
        return Unreachable(travel, f"the arm meets a wall on its way in at yaw {degrees:.0f} degrees", 0)
    before, there = np.array([*(tip - length * ahead), yaw]), np.array([*tip, yaw])
    poses, phases = ([before, there, before], BOTH) if back else ([before, there], BOTH[:1])
    return GripperPath(np.array(poses), phases, dict.fromkeys(phases, PhaseRule(1.0, opening, Contacts.NONE)))


def way_length(view: ArmView, place: Sequence[float], yaw: float) -> float:
    """Of the way to a place from where all of the arm is well before the mouth (m)."""
    return (place[0] + float(view.silhouette(yaw).front) + MOUTH_CLEARANCE) / math.cos(yaw)
