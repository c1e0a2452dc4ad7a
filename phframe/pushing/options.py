"""Options that every planner built on the paper's pushes shares."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from phframe.core import Options

Speed = Annotated[float, Field(gt=0.0, le=2.0)]
Clearance = Annotated[float, Field(ge=0.0, le=0.1)]
ROUNDING = 1e-9
"""Of angles (rad): one that is at its limit but for rounding is within it."""


class PushingOptions(Options):
    """Figures of the paper and its open ends.

    Attributes:
        half_width: Of the corridor, w (m); ``auto``: half the arm's link, the largest obstacle's radius and 4 mm.
        insertion_width: Width of what must fit between two groups (m); 0.018 gives the paper's threshold of 0.08.
        margin: By how much a radius must be persistent, nu (m).
        sweeps: ``paper``: the one sweep of Algorithm 3, as it is but for the walls; ``fitted``: of several that fit, the
            best one first.
        max_actions: Pushes after which to give up.
        patience: Pushes in a row that make the obstacles in the corridor no fewer, after which to give up.
        insert_speed: Going in and out (m/s).
        sweep_speed: Sweeping (m/s).
        reach_speed: Reaching for the target and drawing it out (m/s).
        wall_clearance: Kept between the sweeping arm and the walls (m).
        lane_clearance: Kept between the arm going in and the component it goes in beside (m).
        target_clearance: Least distance of the sweeping fingertip from the target's centre (radii).
        max_tilt: Greatest tilt of the sweeping arm against the corridor (rad); 0: none.
        neighbour_clearance: Kept between the reaching arm and walls and objects (m).
        max_grasp_turn: Greatest deviation of the reaching gripper from the corridor's axis (rad).
        withdrawal: How far outside the mouth the whole target is drawn (m).
    """

    half_width: Annotated[float, Field(gt=0.0, le=1.0)] | Literal["auto"] = 0.12
    insertion_width: Annotated[float, Field(ge=0.0, le=1.0)] = 0.018
    margin: Annotated[float, Field(ge=0.0, le=1.0)] = 0.015
    sweeps: Literal["paper", "fitted"] = "fitted"
    max_actions: Annotated[int, Field(ge=1, le=1000)] = 30
    patience: Annotated[int, Field(ge=1, le=1000)] = 5
    insert_speed: Speed = 0.25
    sweep_speed: Speed = 0.2
    reach_speed: Speed = 0.25
    wall_clearance: Clearance = 0.002
    lane_clearance: Clearance = 0.005
    target_clearance: Annotated[float, Field(ge=1.0, le=10.0)] = 1.2
    max_tilt: Annotated[float, Field(ge=0.0, le=math.pi / 4.0)] = 0.5236
    neighbour_clearance: Clearance = 0.002
    max_grasp_turn: Annotated[float, Field(ge=0.0, le=math.pi / 4.0)] = 0.2618
    withdrawal: Annotated[float, Field(gt=0.0, le=1.0)] = 0.10


class ClearingOptions(PushingOptions):
    """Options of planners that push until the corridor is empty.

    Attributes:
        grasp_first: Whether the grasp is tried before every push, while the corridor still holds obstacles.
    """

    grasp_first: bool = False
