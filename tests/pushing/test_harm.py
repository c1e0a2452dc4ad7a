"""Each kind of harm is told, the worst of what the arm did first, and what is meant to happen is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import ArmState, Condition, Contact, Motion, Phase, State, StopCause, StopReason, Transition
from phframe.pushing import MOVED_TARGET, harm
from tests.pushing.parts import scene_of

SCENE = scene_of((0.45, 0.3), (0.2, 0.3), (0.2, 0.4))
BEFORE = SCENE.initial_state()
WALL = Contact(0.5, "north wall", Phase.SWEEP)
TOUCHED = Motion(1.0, wall_contacts=(WALL,))
STOPPED = Motion(1.0, stopped=StopReason(StopCause.WALL, "north wall"))
STALLED = Motion(1.0, stalled=True, largest_force=31.4)


def condition(row: int, what: Condition, before: State = BEFORE) -> State:
    conditions = list(before.conditions)
    conditions[row] = what
    return replace(before, conditions=tuple(conditions))


def displaced(row: int, by: float) -> State:
    poses = BEFORE.poses.copy()
    poses[row, 1] += by
    return replace(BEFORE, poses=poses)


def test_where_nothing_happens_there_is_none() -> None:
    assert harm(SCENE, BEFORE, Transition(BEFORE, Motion(1.0))) == ""
    assert harm(SCENE, BEFORE, Transition(displaced(1, 0.2), Motion(1.0))) == ""


@pytest.mark.parametrize(
    ("motion", "after", "words"),
    [
        (TOUCHED, BEFORE, "the arm touches the north wall"),
        (STOPPED, BEFORE, "contact with the north wall"),
        (STALLED, BEFORE, "the arm stalls at 31 N"),
        (Motion(1.0), condition(1, Condition.TOPPLED), "o0 is toppled"),
        (Motion(1.0), condition(2, Condition.SPILLED), "o1 is spilled"),
        (Motion(1.0), condition(0, Condition.SPILLED), "target is spilled"),
        (Motion(1.0), displaced(0, 0.0201), "the target moves by more than 20 mm"),
    ],
    ids=["wall", "stopped", "stalled", "toppled", "spilled", "target spilled", "target moved"],
)
def test_each_kind_is_told(motion: Motion, after: State, words: str) -> None:
    assert harm(SCENE, BEFORE, Transition(after, motion)) == words


def test_what_the_arm_did_comes_before_what_became_of_objects() -> None:
    after = replace(displaced(0, 0.1), conditions=condition(1, Condition.TOPPLED).conditions)
    worst = Motion(1.0, wall_contacts=(WALL,), stopped=StopReason(StopCause.FORCE, force=40.0), stalled=True)
    motions = (
        worst,
        replace(worst, wall_contacts=()),
        replace(worst, wall_contacts=(), stopped=None),
        Motion(1.0),
    )
    made = [Transition(after, motion) for motion in motions] + [Transition(displaced(0, 0.1), Motion(1.0))]
    told = [harm(SCENE, BEFORE, each) for each in made]
    assert [each.split()[0:3] for each in told] == [
        ["the", "arm", "touches"],
        ["a", "force", "of"],
        ["the", "arm", "stalls"],
        ["o0", "is", "toppled"],
        ["the", "target", "moves"],
    ]


def test_what_lay_before_is_no_harm() -> None:
    lying = condition(1, Condition.TOPPLED)
    assert harm(SCENE, lying, Transition(lying, Motion(1.0))) == ""
    assert harm(SCENE, lying, Transition(condition(2, Condition.TOPPLED, lying), Motion(1.0))) == "o1 is toppled"


@given(st.floats(0.0, 0.3), st.floats(0.001, 0.2))
def test_the_target_may_be_moved_as_far_as_allowed(by: float, allowed: float) -> None:
    made = Transition(displaced(0, by), Motion(1.0))
    apart = float(np.linalg.norm(made.state.positions[0] - BEFORE.positions[0]))
    assert bool(harm(SCENE, BEFORE, made, allowed)) is (apart > allowed)
    assert bool(harm(SCENE, BEFORE, made)) is (apart > MOVED_TARGET)
    assert harm(SCENE, BEFORE, made, None) == ""


def test_the_target_in_the_hand_goes_where_the_hand_goes() -> None:
    held = replace(displaced(0, -0.2), held="target", arm=ArmState(np.zeros(3), 0.06))
    assert harm(SCENE, BEFORE, Transition(held, Motion(1.0))) == ""
