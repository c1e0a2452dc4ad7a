"""Checks of the states that a backend takes and gives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from phframe.core import ArmState, Condition, InputError, State, tilt_of
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_close, expect_equal, expect_raises
from phframe.testing.physics.paths import CROWD_SWEEP, OUTSIDE, crowd, drive_in
from phframe.testing.physics.stand import PhysicsStand, on_stand
from phframe.testing.subjects import PhysicsUnderTest


@check
def restore_returns_what_it_holds(subject: PhysicsUnderTest) -> Faults:
    """Physics.restore: make the world be the state, at rest; return what it really holds now."""
    with on_stand(subject, crowd()) as stand:
        for state, what in _states(stand):
            held = stand.physics.restore(state)
            yield from expect_equal(stand.physics.observe(), held, f"what observe gives after restoring {what}")
            yield from expect_equal(stand.physics.restore(state), held, f"what a second restore of {what} returns")
            yield from _expect_near(held, state, stand, what)


@check
def poses_are_in_the_shelf_frame(subject: PhysicsUnderTest) -> Faults:
    """State.poses: (n, 7) in the shelf frame, in the order of the scene's objects: x y z of the centre, unit quaternion."""
    with on_stand(subject, crowd()) as stand:
        halves = [item.shape.height / 2.0 for item in stand.scene.objects]
        for state, what in _states(stand):
            found = stand.physics.restore(state)
            yield from expect_equal(found.poses.shape, (len(halves), 7), f"the shape of the poses, {what}")
            lengths = np.linalg.norm(found.poses[:, 3:], axis=1)
            yield from expect_close(lengths, np.ones(len(halves)), 1e-9, f"lengths of the quaternions, {what}")
            up = [condition is Condition.UPRIGHT for condition in found.conditions]
            height = found.poses[up, 2]
            yield from expect_close(
                height, np.array(halves)[up], subject.tolerances.height, f"z of upright objects, {what}"
            )
            tilts = [tilt_of(pose) for pose in found.poses[up]]
            yield from expect(max(tilts, default=0.0) < 0.1, f"upright objects to stand, {what}", f"tilts {tilts}")
            yield from expect(not found.poses.flags.writeable, "read-only poses", "writable ones")


@check
def a_scene_is_at_rest_as_written(subject: PhysicsUnderTest) -> Faults:
    """Scene.initial_state: every object upright at its position, the arm parked; an arm before the mouth moves nothing."""
    with on_stand(subject, crowd()) as stand:
        found = stand.run(stand.start, drive_in(OUTSIDE / 2.0))
        moved = float(np.abs(found.state.poses[:, :3] - stand.start.poses[:, :3]).max())
        limit = subject.tolerances.untouched + subject.tolerances.restored
        yield from expect(
            moved <= limit, f"objects within {limit:g} m of where the scene has them", f"{moved:.3g} m away"
        )
        yield from expect_equal(found.state.conditions, stand.start.conditions, "the conditions")
        yield from expect_equal((found.motion.contacts, found.motion.wall_contacts), ((), ()), "contacts")
        yield from expect(found.motion.complete, "the trajectory followed to its end", str(found.motion))


@check
def what_has_spilled_stays_where_it_was_seen(subject: PhysicsUnderTest) -> Faults:
    """State: an object that spilled keeps the last pose it was seen at, and is in nobody's way."""
    with on_stand(subject, crowd()) as stand:
        conditions = (Condition.SPILLED, *stand.start.conditions[1:])
        poses = stand.start.poses.copy()
        poses[0, :2] = -0.04, 0.3
        state = State(poses, conditions)
        found = stand.run(state, drive_in(0.1))
        for seen in (stand.physics.restore(state), found.state):
            yield from expect_equal(seen.poses[0].tolist(), poses[0].tolist(), "the pose of what has spilled")
            yield from expect_equal(seen.conditions[0], Condition.SPILLED, "its condition")
        touched = [contact.body for contact in found.motion.contacts]
        yield from expect(not touched, "no contact with what has spilled", str(touched))


@check
def bad_states_are_refused(subject: PhysicsUnderTest) -> Faults:
    """Physics.restore raises InputError if the state is not one of this scene and this arm."""
    with on_stand(subject, crowd()) as stand:
        for state, what in _bad_states(stand.start):
            yield from expect_raises(InputError, partial(stand.physics.restore, state), what)
        yield from expect_equal(
            stand.physics.restore(stand.start).conditions, stand.start.conditions, "a good state after"
        )


@check
def closing_twice_is_allowed(subject: PhysicsUnderTest) -> Faults:
    """Physics.close: give the engine's memory back; may be called twice."""
    stand = PhysicsStand(subject, crowd())
    stand.physics.close()
    stand.physics.close()
    stand = PhysicsStand(subject, crowd())
    stand.run(stand.start, drive_in(0.1))
    stand.physics.close()
    stand.physics.close()
    yield from ()


def _states(stand: PhysicsStand) -> Iterator[tuple[State, str]]:
    yield stand.start, "the scene as written"
    pushed = stand.run(stand.start, CROWD_SWEEP)
    yield pushed.state, "the state after a sweep"
    inside = stand.run(stand.start, drive_in(0.25, 0.2), settle=None)
    yield inside.state, "a state with the arm inside the shelf"
    if inside.state.held is None:
        yield inside.state.parked(), "a state with the arm parked again"


def _bad_states(start: State) -> Iterator[tuple[State, str]]:
    for value, what in ((np.nan, "not a number"), (np.inf, "infinite")):
        poses = start.poses.copy()
        poses[1, 0] = value
        yield State(poses, start.conditions), f"a position that is {what}"
    yield State(start.poses[:-1], start.conditions[:-1]), "a state with an object too few"
    yield (
        State(np.vstack([start.poses, start.poses[:1]]), (*start.conditions, Condition.UPRIGHT)),
        "one object too many",
    )
    arm = ArmState(np.array([OUTSIDE, 0.3, 0.0]), 0.05)
    yield replace(start, held="nobody", arm=arm), "an unknown object in the hand"
    yield replace(start, arm=ArmState(np.array([np.nan, 0.3, 0.0]), 0.0)), "an arm at no place"


def _expect_near(found: State, wanted: State, stand: PhysicsStand, what: str) -> Faults:
    tolerance = stand.tolerances.restored
    yield from expect_close(found.poses[:, :3], wanted.poses[:, :3], tolerance, f"positions after restoring {what}")
    yield from expect_equal(found.conditions, wanted.conditions, f"conditions after restoring {what}")
    yield from expect_equal(found.held, wanted.held, f"what is held after restoring {what}")
    yield from expect((found.arm is None) == (wanted.arm is None), f"an arm parked as before, {what}", str(found.arm))
    if found.arm is not None and wanted.arm is not None:
        yield from expect_close(found.arm.gripper, wanted.arm.gripper, 10.0 * tolerance, f"the gripper, {what}")
        yield from expect_close(found.arm.opening, wanted.arm.opening, 10.0 * tolerance, f"the opening, {what}")


STATE_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    restore_returns_what_it_holds,
    poses_are_in_the_shelf_frame,
    a_scene_is_at_rest_as_written,
    what_has_spilled_stays_where_it_was_seen,
    bad_states_are_refused,
    closing_twice_is_allowed,
)
