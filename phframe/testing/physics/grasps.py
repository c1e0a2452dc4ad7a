"""Checks of what the hand holds."""

from __future__ import annotations

import numpy as np

from phframe.core import Condition, FloatArray, Phase, Scene, State, compose, inverse, planar_pose
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_close, expect_equal
from phframe.testing.physics.paths import MIDDLE, cylinder, grasp, graspable_radius, path, scene_of
from phframe.testing.physics.stand import Film, on_stand
from phframe.testing.subjects import PhysicsUnderTest

DEPTH = 0.25
"""x of the target (m)."""


@check
def a_grasped_target_comes_out(subject: PhysicsUnderTest) -> Faults:
    """State.held: a target between the closing fingers is held and leaves with the arm; in the hand, it has not spilled."""
    with on_stand(subject, _scene(subject)) as stand:
        film = Film(0.02)
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
)
