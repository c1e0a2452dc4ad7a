"""What a grasp came to is looked at, not believed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from phframe.core import ArmState, Condition, Contact, Contacts, GripperPath, Motion, Phase, State, Status
from phframe.pushing.options import PushingOptions
from phframe.pushing.outcome import grasp_outcome, is_cleared
from phframe.pushing.reach import Grasp, grasp_action
from tests.pushing.parts import ARM, HALF_WIDTH, scene_of
from tests.pushing.test_reach import corridor_of

FREE = scene_of((0.4, 0.3), (0.4, 0.45))
BLOCKED = scene_of((0.4, 0.3), (0.2, 0.3))


def path() -> GripperPath:
    found = grasp_action(FREE, FREE.initial_state(), corridor_of(FREE), ARM, PushingOptions())
    assert isinstance(found, Grasp)
    return found.action.path


def drawn(x: float, held: str | None = "target") -> State:
    """The target at a depth, in the hand or not."""
    state = FREE.initial_state()
    poses = state.poses.copy()
    poses[0, 0] = x
    return replace(state, poses=poses, held=held, arm=ArmState(path().poses[-1], 0.06))


def outcome(state: State, motion: Motion, *, at_pose: bool = True) -> tuple[Status, str]:
    return grasp_outcome(FREE, state, path(), motion, at_pose=at_pose, half_width=HALF_WIDTH)


def touched(body: str, phase: Phase = Phase.REACH, *, wall: bool = False) -> Motion:
    contacts = (Contact(0.1, body, phase),)
    return Motion(1.0, wall_contacts=contacts) if wall else Motion(1.0, contacts=contacts)


def test_in_the_hand_and_all_of_it_out_is_retrieved() -> None:
    assert outcome(drawn(-0.13), touched("target")) == (Status.RETRIEVED, "")
    assert outcome(drawn(-0.031), Motion(1.0)) == (Status.RETRIEVED, "")


def test_in_the_hand_but_not_all_of_it_out_is_reached() -> None:
    assert outcome(drawn(-0.029), Motion(1.0)) == (Status.REACHED, "the target was not drawn out")


def test_out_but_not_in_the_hand_is_not_retrieved() -> None:
    assert outcome(drawn(0.4, None), touched("target")) == (Status.REACHED, "the target was not held")
    assert outcome(drawn(0.4, None), touched("o0", Phase.WITHDRAW))[0] is Status.REACHED


@pytest.mark.parametrize("motion", [touched("o0"), touched("north wall", wall=True)], ids=["object", "wall"])
def test_a_reach_that_touches_what_it_must_not_has_not_reached(motion: Motion) -> None:
    assert outcome(drawn(0.4, None), motion) == (Status.CLEARED, "the reach touched what it must not")


def test_a_path_that_allows_objects_may_touch_them_but_no_wall() -> None:
    rules = {**path().rules, Phase.REACH: replace(path().rules[Phase.REACH], contacts=Contacts.OBJECTS)}
    allowed = replace(path(), rules=rules)
    for motion, status in ((touched("o0"), Status.REACHED), (touched("back wall", wall=True), Status.CLEARED)):
        found, _ = grasp_outcome(FREE, drawn(0.4, None), allowed, motion, at_pose=True, half_width=HALF_WIDTH)
        assert found is status


def test_a_reach_that_stalls_is_cleared_only_where_the_corridor_is_empty() -> None:
    stalled = Motion(1.0, stalled=True)
    assert outcome(drawn(0.4, None), stalled, at_pose=False) == (Status.CLEARED, "the reach stalled")
    blocked = grasp_outcome(BLOCKED, BLOCKED.initial_state(), path(), stalled, at_pose=False, half_width=HALF_WIDTH)
    assert blocked == (Status.FAILED, "the reach stalled")


def test_cleared_is_an_empty_corridor_of_the_width_given() -> None:
    beside = scene_of((0.4, 0.3), (0.3, 0.4))
    assert is_cleared(beside, beside.initial_state(), 0.09)
    assert not is_cleared(beside, beside.initial_state(), 0.11)


def test_what_has_spilled_is_not_in_the_corridor_and_a_lost_target_has_none() -> None:
    state = BLOCKED.initial_state()
    assert not is_cleared(BLOCKED, state, HALF_WIDTH)
    assert is_cleared(BLOCKED, replace(state, conditions=(Condition.UPRIGHT, Condition.SPILLED)), HALF_WIDTH)
    for lost in (Condition.SPILLED, Condition.TOPPLED):
        assert not is_cleared(FREE, replace(FREE.initial_state(), conditions=(lost, Condition.UPRIGHT)), HALF_WIDTH)
    assert not is_cleared(FREE, FREE.initial_state(), 0.31), "a shelf narrower than the corridor"
