"""Checks of what the hand holds."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    Condition,
    FloatArray,
    GripperPath,
    Phase,
    Scene,
    State,
    compose,
    inverse,
    planar_pose,
)
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_close, expect_equal
from phframe.testing.physics.paths import MIDDLE, OUTSIDE, cylinder, drive_in, grasp, graspable_radius, path, scene_of
from phframe.testing.physics.stand import WatchLog, on_stand
from phframe.testing.subjects import PhysicsUnderTest

DEPTH = 0.25
"""x of the target (m)."""
ASIDE = 0.1
"""How far the target is carried along the mouth (m)."""


@check
def a_grasped_target_comes_out(subject: PhysicsUnderTest) -> Faults:
    """State.held: a target between the closing fingers is held and leaves with the arm; in the hand, it has not spilled."""
    with on_stand(subject, _scene(subject)) as stand:
        film = WatchLog(0.02)
        made = stand.run(stand.start, grasp(stand.arm, DEPTH), watch=film.watch)
        yield from expect_equal(made.state.held, "target", "what is held")
        yield from expect_equal(made.state.conditions, (Condition.UPRIGHT,) * 2, "the conditions")
        x = float(stand.center(made.state, "target")[0])
        yield from expect_close(x, -0.14, 0.02, "x of the target's centre, 2 cm before the fingertip (m)")
        yield from expect(made.motion.complete, "the whole trajectory followed", str(made.motion))
        relative = np.array([_in_hand(state) for state in film.states if state.held])
        slip = float(np.ptp(relative, axis=0).max()) if len(relative) else np.inf
        yield from expect_at_most(slip, subject.tolerances.slipped, "how far it slips in the hand (m)")
        others = float(made.state.displacement(stand.start)[0])
        yield from expect_at_most(others, subject.tolerances.untouched, "how far the other object moves (m)")


@check
def fingers_stop_at_what_they_hold(subject: PhysicsUnderTest) -> Faults:
    """ArmState: opening is the distance between the fingers; command is what they are told, less while they squeeze."""
    with on_stand(subject, _scene(subject)) as stand:
        arm = stand.run(stand.start, grasp(stand.arm, DEPTH, withdraw=False)).state.arm
        if arm is None:
            yield from expect(False, "where the arm is", "an arm that is parked")
            return
        width = 2.0 * graspable_radius(subject.arm)
        yield from expect_close(arm.opening, width, 0.005, "the opening, as wide as the target (m)")
        yield from expect_close(
            arm.commanded_opening, subject.arm.shape.min_opening, 0.001, "the commanded opening (m)"
        )


@check
def a_held_target_survives_restoring(subject: PhysicsUnderTest) -> Faults:
    """Physics.restore: what the state says is held is held."""
    with on_stand(subject, _scene(subject)) as stand:
        gripped = stand.run(stand.start, grasp(stand.arm, DEPTH, withdraw=False)).state
        yield from expect_equal(gripped.held, "target", "what is held")
        restored = stand.physics.restore(gripped)
        yield from expect_equal(restored.held, "target", "what is held after restoring")
        if gripped.arm is None:
            return
        out = path(_way(gripped.arm.gripper, -0.12), [Phase.WITHDRAW], opening=subject.arm.shape.min_opening)
        made = stand.run(gripped, out)
        yield from expect_equal(made.state.held, "target", "what is held after withdrawing")
        yield from expect_equal(made.state.conditions, gripped.conditions, "the conditions after withdrawing")
        slip = float(np.abs(_in_hand(made.state) - _in_hand(gripped)).max())
        yield from expect_at_most(slip, subject.tolerances.slipped, "how far it slips in the hand (m)")


@check
def fingers_that_close_on_nothing_hold_nothing(subject: PhysicsUnderTest) -> Faults:
    """State.held: id of the object in the gripper, or None."""
    with on_stand(subject, _scene(subject)) as stand:
        made = stand.run(stand.start, grasp(stand.arm, DEPTH, 0.12))
        yield from expect_equal(made.state.held, None, "what is held")
        opening = np.nan if made.state.arm is None else made.state.arm.opening
        wanted = subject.arm.shape.min_opening
        yield from expect_close(opening, wanted, 2.0 * subject.tolerances.tracking, "the opening, closed (m)")


@check
def open_fingers_let_go(subject: PhysicsUnderTest) -> Faults:
    """State.held: held until it is seen to be lost; fingers that open wider than the object hold it no longer."""
    with on_stand(subject, _scene(subject)) as stand:
        gripped = stand.run(stand.start, grasp(stand.arm, DEPTH, withdraw=False)).state
        if gripped.arm is None or gripped.held is None:
            yield from expect(False, "a target in the hand", str(gripped.held))
            return
        wide, place = subject.arm.shape.max_opening, gripped.arm.gripper
        made = stand.run(gripped, path([place, place], [Phase.REACH], opening=wide))
        yield from expect_equal(made.state.held, None, "what is held by open fingers")
        back = stand.run(made.state, path(_way(place, -0.05), [Phase.RETREAT], opening=wide))
        x = float(stand.center(back.state, "target")[0])
        yield from expect_close(x, DEPTH, 0.01, "x of the target that was let go (m)")


@check
def what_is_placed_stays(subject: PhysicsUnderTest) -> Faults:
    """Physics.execute: fingers that open in any leg let go of what they hold; it then stands on the board, free."""
    with on_stand(subject, _scene(subject)) as stand:
        film = WatchLog(0.02)
        made = stand.run(stand.start, _place(subject.arm), watch=film.watch)
        yield from expect(made.motion.complete, "the whole trajectory followed", str(made.motion))
        yield from expect(any(state.held == "target" for state in film.states), "'target' held on the way", "never")
        yield from expect_equal((made.state.held, made.state.conditions[1]), (None, Condition.UPRIGHT), "what is held")
        placed = next((s for before, s in pairwise(film.states) if before.held and not s.held), film.states[-1])
        wanted = [DEPTH, MIDDLE - ASIDE]
        yield from expect_close(stand.center(placed, "target"), wanted, 0.02, "where the target is put down (m)")
        left = float(placed.displacement(made.state)[1])
        yield from expect_at_most(left, subject.tolerances.slipped, "how far it goes after it was let go (m)")
        pushed = stand.run(made.state, drive_in(DEPTH, MIDDLE - ASIDE)).state
        moved = float(stand.center(pushed, "target")[0]) - DEPTH
        yield from expect(moved > 0.01, "a target that can be pushed afterwards", f"it moves by {moved:.4f} m")


@check
def a_held_target_passes_the_mouth_at_an_angle(subject: PhysicsUnderTest) -> Faults:
    """Shelf: the walls end at the mouth; what is drawn out at an angle meets none outside."""
    radius = graspable_radius(subject.arm)
    target = cylinder("target", 0.2, 0.29, radius=radius)
    with on_stand(subject, scene_of(cylinder("other", 0.45, 0.5), target)) as stand:
        film = WatchLog(0.02)
        made = stand.run(stand.start, _drawn(subject.arm, target.position, math.radians(35.0)), watch=film.watch)
        yield from expect(made.motion.complete, "the whole trajectory followed", str(made.motion))
        held = [state.held for state in film.states]
        kept = "target" in held and set(held[held.index("target") :]) == {"target"}
        yield from expect(kept, "'target' held from the grasp to the end", str(held[-1]))
        lowest = float(stand.center(made.state, "target")[1])
        yield from expect(lowest < radius, f"its centre at y < {radius:g} m in the end", f"{lowest:.3f} m")
        hand = [_in_hand(state) for state in film.states if state.held]
        slip = float(np.ptp(hand, axis=0).max()) if hand else np.inf
        yield from expect_at_most(slip, subject.tolerances.slipped, "how far it slips in the hand (m)")


@check
def what_is_too_heavy_does_not_come_out(subject: PhysicsUnderTest) -> Faults:
    """Trajectory.force_limit: what is held drags along the board; where that takes more than the arm has, it stays."""
    target = cylinder("target", DEPTH, MIDDLE, radius=graspable_radius(subject.arm), mass=40.0)
    with on_stand(subject, scene_of(cylinder("other", 0.45, 0.5), target)) as stand:
        limit = 60.0
        made = stand.run(stand.start, grasp(stand.arm, DEPTH), force_limit=limit)
        dragged = float(made.state.displacement(stand.start)[1])
        yield from expect_at_most(dragged, 0.01, "how far a target comes that takes 98 N to drag (m)")
        gone = made.state.held is None or made.motion.stalled
        yield from expect(gone, "a stall, or a target that slips out of the hand", str(made.motion))
        felt = made.motion.largest_force
        yield from expect(felt > 1.0, "the force told", f"{felt:g} N")


def _place(arm: ArmModel[Any]) -> GripperPath:
    """In, grasp, aside, let go, and out."""
    way = grasp(arm, DEPTH, withdraw=False)
    wide, narrow = way.rules[Phase.REACH], way.rules[Phase.GRASP]
    inside = way.poses[-1]
    aside = inside - np.array([0.0, ASIDE, 0.0])
    poses = np.vstack([way.poses, [aside, aside, [OUTSIDE, aside[1], 0.0]]])
    rules = {**way.rules, Phase.PLACE: narrow, Phase.RELEASE: wide, Phase.RETREAT: wide}
    return GripperPath(poses, (*way.phases, Phase.PLACE, Phase.RELEASE, Phase.RETREAT), rules)


def _drawn(arm: ArmModel[Any], position: tuple[float, float], yaw: float) -> GripperPath:
    """In at an angle, grasp, and out along the same line until the target is beside the shelf."""
    straight, ahead = grasp(arm, 0.0), np.array([math.cos(yaw), math.sin(yaw)])
    inside = np.array(position) + 0.02 * ahead
    before, beyond = (inside - (inside[0] - x) / ahead[0] * ahead for x in (OUTSIDE, -0.25))
    return replace(straight, poses=np.array([[x, y, yaw] for x, y in (before, inside, inside, beyond)]))


def _scene(subject: PhysicsUnderTest) -> Scene:
    return scene_of(
        cylinder("other", 0.45, 0.5), cylinder("target", DEPTH, MIDDLE, radius=graspable_radius(subject.arm))
    )


def _way(begin: FloatArray, x: float) -> FloatArray:
    return np.array([begin, [x, MIDDLE, 0.0]])


def _in_hand(state: State) -> FloatArray:
    """Position ``(2,)`` of the target in the fingertip frame (m)."""
    if state.arm is None:
        return np.full(2, np.inf)
    x, y, yaw = state.arm.gripper
    return compose(inverse(planar_pose(x, y, 0.0, yaw)), state.poses[-1])[:2]


GRASP_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    a_grasped_target_comes_out,
    fingers_stop_at_what_they_hold,
    a_held_target_survives_restoring,
    fingers_that_close_on_nothing_hold_nothing,
    open_fingers_let_go,
    what_is_placed_stays,
    a_held_target_passes_the_mouth_at_an_angle,
    what_is_too_heavy_does_not_come_out,
)
