"""What is checked of a goal: that it judges any world, the same way every time, and says why it is not met."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from phframe.core import (
    Action,
    ArmState,
    Assessment,
    Attempt,
    Condition,
    Contacts,
    GripperPath,
    Motion,
    Phase,
    PhaseRule,
    Scene,
    State,
    Status,
)
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_equal
from phframe.testing.planner.scenes import cluttered
from phframe.testing.subjects import GoalUnderTest

World = tuple[str, State, Attempt | None]


@check
def any_world_can_be_judged(subject: GoalUnderTest) -> Faults:
    """Goal.assess: an Assessment of any state, whatever lies, is gone or is held, and whatever was done last."""
    scene = cluttered(0)
    for name, state, last in _worlds(scene):
        found = subject.goal.assess(scene, state, last)
        yield from expect(isinstance(found, Assessment), f"an Assessment of {name}", repr(found))


@check
def goals_are_stateless(subject: GoalUnderTest) -> Faults:
    """Goal: stateless; it judges what it is shown."""
    scene = cluttered(0)
    first = [subject.goal.assess(scene, state, last) for _, state, last in _worlds(scene)]
    again = [subject.goal.assess(scene, state, last) for _, state, last in reversed(list(_worlds(scene)))]
    yield from expect_equal(again[::-1], first, "the assessments of the same worlds, asked for in another order")


@check
def what_is_not_met_says_why(subject: GoalUnderTest) -> Faults:
    """Assessment.reason: why no farther, for people; empty where the goal is met."""
    scene = cluttered(0)
    for name, state, last in _worlds(scene):
        found = subject.goal.assess(scene, state, last)
        yield from expect(
            bool(found.reason) is not found.status.is_success, f"a reason unless it is met, for {name}", repr(found)
        )
        yield from expect(
            not (found.lost and found.status.is_success), f"a goal that is met is not lost: {name}", repr(found)
        )
        yield from expect(
            found.status is not Status.TIMEOUT, f"a status that a world can have, for {name}", found.status
        )


@check
def what_is_judged_is_not_changed(subject: GoalUnderTest) -> Faults:
    """Goal.assess: it reads what it is given."""
    scene = cluttered(0)
    for name, state, last in _worlds(scene):
        before = pickle.dumps((scene, state, last))
        subject.goal.assess(scene, state, last)
        yield from expect(pickle.dumps((scene, state, last)) == before, f"{name} left as it was", "it was changed")


def _worlds(scene: Scene) -> Iterator[World]:
    """Worlds at the beginning, in between and at the end, with what was done last."""
    begin, row = scene.initial_state(), scene.target_index
    yield "the beginning", begin, None
    for condition in (Condition.TOPPLED, Condition.SPILLED):
        conditions = tuple(condition if number == row else was for number, was in enumerate(begin.conditions))
        yield f"a target that is {condition}", replace(begin, conditions=conditions), None
    stalled = Motion(1.0, stalled=True, largest_force=60.0)
    for motion in (Motion(1.0), stalled):
        yield "a push", begin, Attempt(_push(), motion)
    arm = ArmState(np.array([-0.2, 0.3, 0.0]), 0.06)
    for held in scene.ids:
        poses = begin.poses.copy()
        poses[scene.index(held), 0] = -0.2
        yield f"{held} in the hand, before the mouth", replace(begin, poses=poses, held=held, arm=arm), None
        yield f"{held} in the hand, in the shelf", replace(begin, held=held, arm=arm), Attempt(_push(), stalled)


def _push() -> Action:
    rule = PhaseRule(0.2, 0.0, Contacts.OBJECTS)
    return Action(
        "in", GripperPath(np.array([[-0.1, 0.3, 0.0], [0.1, 0.3, 0.0]]), (Phase.INSERT,), {Phase.INSERT: rule})
    )


GOAL_CHECKS: tuple[Check[GoalUnderTest], ...] = (
    any_world_can_be_judged,
    goals_are_stateless,
    what_is_not_met_says_why,
    what_is_judged_is_not_changed,
)
