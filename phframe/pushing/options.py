"""Options that every planner built on the paper's pushes shares."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from phframe.core import Options

Speed = Annotated[float, Field(gt=0.0, le=2.0)]


class PushingOptions(Options):
    """Figures of the paper and its open ends.

    Attributes:
        half_width: Of the corridor, w (m); ``auto``: half the arm's link, the largest obstacle's radius and 4 mm.
        insertion_width: Width of what must fit between two groups (m); 0.018 gives the paper's threshold of 0.08.
        margin: By how much a radius must be persistent, nu (m).
        max_actions: Pushes after which to give up.
        patience: Pushes in a row that make the obstacles in the way no fewer, after which to give up.
        insert_speed: Going in and out (m/s).
        sweep_speed: Sweeping (m/s).
        reach_speed: Reaching for the target and drawing it out (m/s).
    """

    half_width: Annotated[float, Field(gt=0.0, le=1.0)] | Literal["auto"] = 0.12
    insertion_width: Annotated[float, Field(ge=0.0, le=1.0)] = 0.018
    margin: Annotated[float, Field(ge=0.0, le=1.0)] = 0.015
    max_actions: Annotated[int, Field(ge=1, le=1000)] = 30
    patience: Annotated[int, Field(ge=1, le=1000)] = 5
    insert_speed: Speed = 0.25
    sweep_speed: Speed = 0.2
    reach_speed: Speed = 0.25
