"""Every check of goals finds a goal that breaks its promise."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from phframe.core import Assessment, Attempt, Condition, Scene, State, Status
from phframe.pushing import Retrieve, RetrieveOptions
from phframe.testing import GOAL_CHECKS, Check, ConformanceError, GoalUnderTest, check_goal


class GivesUpOnWhatLies(Retrieve):
    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        if state.conditions[scene.target_index] is not Condition.UPRIGHT:
            raise ValueError("it lies")
        return super().assess(scene, state, last)


class Remembers(Retrieve):
    seen = 0

    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        self.seen += 1
        found = super().assess(scene, state, last)
        return replace(found, reason=f"{found.reason} ({self.seen})") if found.reason else found


class Silent(Retrieve):
    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        return replace(super().assess(scene, state, last), reason="")


class Meddles(Retrieve):
    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        object.__setattr__(state, "poses", np.zeros_like(state.poses))
        return Assessment(Status.FAILED, "no")


BROKEN: dict[str, type[Retrieve]] = {
    "any_world_can_be_judged": GivesUpOnWhatLies,
    "goals_are_stateless": Remembers,
    "what_is_not_met_says_why": Silent,
    "what_is_judged_is_not_changed": Meddles,
}


@pytest.mark.parametrize("check", GOAL_CHECKS, ids=lambda check: check.name)
def test_every_check_can_fail(check: Check[Any]) -> None:
    check(GoalUnderTest(Retrieve(RetrieveOptions())))
    with pytest.raises(ConformanceError, match=check.name):
        check(GoalUnderTest(BROKEN[check.name](RetrieveOptions())))


def test_a_goal_that_keeps_to_it_passes_all() -> None:
    assert len(check_goal(Retrieve(RetrieveOptions(half_width=0.2))).passed) == len(GOAL_CHECKS)
