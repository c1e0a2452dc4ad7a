"""What a grasp came to is looked at, not believed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from phframe.core import (
    Action,
    ArmState,
    Attempt,
    Condition,
    Contact,
    Contacts,
    Motion,
    Phase,
    Scene,
    SceneError,
    State,
    Status,
    time_path,
)
from phframe.pushing import Grasp, PushingOptions, Retrieve, RetrieveOptions, grasp_action, is_cleared
from tests.pushing.parts import ARM, HALF_WIDTH, RETRIEVE, scene_of
from tests.pushing.test_grasp import corridor_of

FREE = scene_of((0.4, 0.3), (0.4, 0.45))
BLOCKED = scene_of((0.4, 0.3), (0.2, 0.3))


def grasp() -> Action:
    found = grasp_action(FREE, FREE.initial_state(), corridor_of(FREE), ARM, PushingOptions())
    assert isinstance(found, Grasp)
    return found.action


def drawn(x: float, held: str | None = "target") -> State:
    """The target at a depth, in the hand or not."""
    state = FREE.initial_state()
    poses = state.poses.copy()
    poses[0, 0] = x
    return replace(state, poses=poses, held=held, arm=ArmState(grasp().path.poses[-1], 0.06))


def outcome(state: State, motion: Motion, action: Action | None = None, scene: Scene = FREE) -> tuple[Status, str]:
    found = RETRIEVE.assess(scene, state, Attempt(action or grasp(), motion))
    return found.status, found.reason


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
    path = grasp().path
    rules = {**path.rules, Phase.REACH: replace(path.rules[Phase.REACH], contacts=Contacts.OBJECTS)}
    allowed = replace(grasp(), path=replace(path, rules=rules))
    for motion, status in ((touched("o0"), Status.REACHED), (touched("back wall", wall=True), Status.CLEARED)):
        assert outcome(drawn(0.4, None), motion, allowed)[0] is status


def test_a_reach_that_stalls_is_cleared_only_where_the_corridor_is_empty() -> None:
    stalled = Motion(1.0, stalled=True, largest_force=60.0)
    told = "the reach stalled: the arm stalled at 60 N"
    assert outcome(drawn(0.4, None), stalled) == (Status.CLEARED, told)
    assert outcome(BLOCKED.initial_state(), stalled, scene=BLOCKED) == (Status.FAILED, told)


def test_a_withdrawal_that_stalls_came_after_the_grasp_pose_was_reached() -> None:
    trajectory = time_path(grasp().path, 0.08, 60.0)
    at_pose = float(trajectory.times[1])
    for followed, status in ((at_pose + 0.5, Status.REACHED), (at_pose - 0.1, Status.CLEARED)):
        motion = Motion(1.0, stalled=True, largest_force=60.0, followed=followed)
        found = RETRIEVE.assess(FREE, drawn(0.4), Attempt(grasp(), motion, trajectory))
        assert (found.status, found.lost) == (status, True), "with the target in the hand nothing can be pushed"
        assert "stalled at 60 N" in found.reason


def test_a_target_that_does_not_stand_is_lost_and_so_is_a_hand_with_something_else() -> None:
    for condition in (Condition.TOPPLED, Condition.SPILLED):
        fallen = replace(FREE.initial_state(), conditions=(condition, Condition.UPRIGHT))
        found = RETRIEVE.assess(FREE, fallen)
        assert (found.status, found.lost, str(condition) in found.reason) == (Status.FAILED, True, True)
    wrong = RETRIEVE.assess(FREE, drawn(0.4, "o0"))
    assert (wrong.status, wrong.reason, wrong.lost) == (Status.FAILED, "o0 is in the hand instead of target", True)
    assert not RETRIEVE.assess(FREE, FREE.initial_state()).lost


def test_another_object_than_the_scenes_target_may_be_retrieved() -> None:
    other = Retrieve(RetrieveOptions(target="o0"))
    assert other.scene(FREE).target == "o0"
    assert other.assess(FREE, drawn(-0.13)).status is Status.FAILED
    with pytest.raises(SceneError, match="'nobody'"):
        Retrieve(RetrieveOptions(target="nobody")).assess(FREE, FREE.initial_state())


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
