from __future__ import annotations

from dataclasses import replace

import numpy as np

from phframe.core import Motion, Plan, Status, StopCause, StopReason
from phframe.pushing import Corridor, PushDecision
from phframe.recorders import narration
from tests.recorders.synthetic_episode import SCENE, hand_made


def test_page_tells_the_decision_and_afterwards_the_outcome() -> None:
    step = hand_made().episode.steps[0]
    before, after = (narration.decision_page(step, SCENE, 1, done) for done in (False, True))
    assert "**persistent radii**: 76, 152 mm" in before
    assert "**chosen component**: object_1, object_2" in before
    assert "outcome" not in before
    assert "**outcome**: 3.0 s, largest force 12 N" in after


def test_angled_corridor_says_along_which_wall() -> None:
    step = hand_made().episode.steps[0]
    angled = Corridor(np.zeros(2), np.deg2rad(31.0), 0.0, 0.12, 0.0, 0.4, "north")
    page = narration.decision_page(
        replace(step, decision=replace(PushDecision.of(step.decision), corridor=angled)), SCENE, 1, False
    )
    assert "along the north wall, 31°, 240 mm wide" in page


def test_stalled_and_stopped_are_told_and_go_wrong() -> None:
    step = hand_made().episode.steps[0]
    assert not narration.went_wrong(step, SCENE)
    for motion, words in (
        (Motion(1.0, stalled=True), "stalled at the force limit"),
        (Motion(1.0, stopped=StopReason(StopCause.WALL, "north wall")), "stopped: contact with the north wall"),
    ):
        stuck = replace(step, motion=motion)
        assert narration.went_wrong(stuck, SCENE)
        assert words in narration.outcome_line(stuck, SCENE, 1)


def test_failed_plan_says_why() -> None:
    line = narration.plan_line(Plan(Status.FAILED, "grasp blocked by object_4"), 1)
    assert line == "plan: 0 actions, expected to end failed: grasp blocked by object_4 (0 ms, 0 simulated actions)"


def test_ending_counts_pushes_and_replans() -> None:
    episode = hand_made().episode
    assert narration.ending_line(episode) == "retrieved; 2 pushes, 1 replan, 40 ms planning, 10.1 s execution"
    assert "3. grasp mug" in narration.ending_page(episode)
