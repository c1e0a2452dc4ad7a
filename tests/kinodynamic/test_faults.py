"""What keeps a search from going on from where a motion led."""

from __future__ import annotations

from dataclasses import replace

import pytest

from phframe.core import Condition, Motion, State, StopCause, StopReason, Transition
from phframe.kinodynamic.faults import fault_of
from tests.pushing.parts import scene_of

UPRIGHT = scene_of((0.4, 0.3), (0.1, 0.3)).initial_state()
TOPPLED = replace(UPRIGHT, conditions=(Condition.UPRIGHT, Condition.TOPPLED))
SPILLED = replace(UPRIGHT, conditions=(Condition.UPRIGHT, Condition.SPILLED))
WALL = StopReason(StopCause.WALL, "south wall")


@pytest.mark.parametrize(
    ("before", "after", "motion", "fault"),
    [
        (UPRIGHT, UPRIGHT, Motion(1.0), ""),
        (UPRIGHT, TOPPLED, Motion(1.0), "something toppled"),
        (UPRIGHT, SPILLED, Motion(1.0), "something spilled"),
        (TOPPLED, SPILLED, Motion(1.0), "something spilled"),
        (TOPPLED, TOPPLED, Motion(1.0), ""),
        (UPRIGHT, UPRIGHT, Motion(1.0, stalled=True, largest_force=41.0), "stalled at 41 N"),
        (UPRIGHT, UPRIGHT, Motion(1.0, stopped=WALL), "contact with the south wall"),
        (UPRIGHT, UPRIGHT, Motion(1.0, settled=False), "not at rest"),
    ],
)
def test_what_went_wrong_is_said(before: State, after: State, motion: Motion, fault: str) -> None:
    assert fault_of(before, Transition(after, motion)) == fault


def test_what_is_steered_need_not_be_at_rest() -> None:
    assert fault_of(UPRIGHT, Transition(UPRIGHT, Motion(1.0, settled=False)), at_rest=False) == ""
