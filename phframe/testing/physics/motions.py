"""Checks of how a backend follows trajectories, and of what it says about that."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from functools import partial

import numpy as np

from phframe.core import (
    ArmState,
    FloatArray,
    GripperTrajectory,
    InputError,
    Phase,
    Settle,
    State,
    Stop,
    StopCause,
    Trajectory,
    compose,
    inverse,
    planar_pose,
)
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_close, expect_equal, expect_raises
from phframe.testing.physics.paths import CROWD_SWEEP, MIDDLE, OUTSIDE, crowd, cylinder, drive_in, path, scene_of, sweep
from phframe.testing.physics.stand import PhysicsStand, WatchLog, on_stand
from phframe.testing.subjects import PhysicsUnderTest

STEP = 0.02
"""No engine steps longer than this (s)."""


@check
def trajectories_are_followed(subject: PhysicsUnderTest) -> Faults:
    """Physics.execute: drive the arm along a trajectory; Motion: how long it took, and how far the fingertip was off."""
    with on_stand(subject, scene_of(cylinder("o", 0.5, 0.5))) as stand:
        way = [[OUTSIDE, MIDDLE, 0.0], [0.2, MIDDLE, 0.0], [0.2, 0.25, 0.1], [0.1, 0.25, -0.1], [OUTSIDE, 0.25, 0.0]]
        trajectory = stand.trajectory(stand.start, path(way, [Phase.REACH] * 4))
        found = stand.physics.simulate(stand.start, trajectory, settle=None)
        gripper = trajectory if isinstance(trajectory, GripperTrajectory) else trajectory.gripper
        motion, tracking = found.motion, subject.tolerances.tracking
        yield from expect(motion.complete, "a trajectory that nothing hinders to be followed", str(motion))
        yield from expect_at_most(motion.tracking_error, tracking, "the tracking error (m)")
        yield from expect_close(motion.duration, gripper.duration, STEP, "the duration (s)")
        yield from expect_close(motion.followed, gripper.duration, STEP, "how much was driven (s)")
        if found.state.arm is None:
            yield from expect(False, "where the arm is", "an arm that is parked")
            return
        yield from expect_close(found.state.arm.gripper, gripper.poses[-1], 2.0 * tracking, "the gripper at the end")


@check
def fingers_open_and_close_as_told(subject: PhysicsUnderTest) -> Faults:
    """ArmState.opening: distance between the fingers (m), as the trajectory has it."""
    shape = subject.arm.shape
    with on_stand(subject, scene_of(cylinder("o", 0.5, 0.5))) as stand:
        state = stand.start
        for opening in (shape.max_opening, shape.min_opening):
            way = path([[OUTSIDE, MIDDLE, 0.0], [0.1, MIDDLE, 0.0]], [Phase.REACH], opening=opening)
            state = stand.run(state, way).state
            seen = np.nan if state.arm is None else state.arm.opening
            yield from expect_close(seen, opening, 2.0 * subject.tolerances.tracking, "the opening (m)")


@check
def execution_goes_on_from_where_the_world_is(subject: PhysicsUnderTest) -> Faults:
    """Physics.execute: drive the arm along a trajectory from where the world is."""
    with on_stand(subject, scene_of(cylinder("o", 0.2, MIDDLE))) as stand:
        stand.physics.restore(stand.start)
        before = stand.start
        for x in (0.2, 0.25, 0.3):
            way = path(
                [[0.0 if before.arm is None else before.arm.gripper[0], MIDDLE, 0.0], [x, MIDDLE, 0.0]], [Phase.INSERT]
            )
            stand.physics.execute(stand.trajectory(before, way), settle=Settle())
            after = stand.physics.observe()
            reached = stand.center(after, "o")[0]
            wanted = x + 0.03 - subject.tolerances.sunk
            yield from expect(
                reached >= wanted, f"the object pushed to x >= {wanted:.4f} m", f"it is at {reached:.4f} m"
            )
            before = after


@check
def trajectories_that_begin_elsewhere_are_refused(subject: PhysicsUnderTest) -> Faults:
    """Physics.execute raises InputError if the trajectory begins more than 2 mm or 0.01 rad from where the arm is."""
    with on_stand(subject, crowd()) as stand:
        state = stand.run(stand.start, drive_in(0.1)).state
        if state.arm is None:
            yield from expect(False, "where the arm is", "an arm that is parked")
            return
        for offset in ([0.01, 0.0, 0.0], [0.0, -0.01, 0.0], [0.0, 0.0, 0.05]):
            jump = partial(stand.physics.simulate, state, _from(stand, state, offset))
            yield from expect_raises(InputError, jump, f"a beginning that is {offset} away from the arm")
        near = stand.physics.simulate(state, _from(stand, state, [0.0005, 0.0, 0.0]))
        yield from expect(near.motion.complete, "a beginning 0.5 mm away to be accepted", str(near.motion))


@check
def waiting_for_rest_changes_nothing_before(subject: PhysicsUnderTest) -> Faults:
    """Physics.execute: settle=None means only not to wait; up to the trajectory's end the same happens either way."""
    with on_stand(subject, crowd()) as stand:
        trajectory = stand.trajectory(stand.start, CROWD_SWEEP)
        films = [WatchLog(1.0 / 60.0), WatchLog(1.0 / 60.0)]
        motions = [
            stand.physics.simulate(stand.start, trajectory, settle=settle, watch=film.watch).motion
            for settle, film in zip((Settle(), None), films, strict=True)
        ]
        ends = [motion.followed for motion in motions]
        yield from expect_close(ends[1], ends[0], 1e-9, "how much is driven (s)")
        tolerance = subject.tolerances.restored
        for time, waited, hurried in zip(films[0].times, films[0].states, films[1].states[:-1], strict=False):
            if waited.arm is not None and hurried.arm is not None:
                where = f"with nobody waiting for rest afterwards, {time:.2f} s after the beginning (m, rad)"
                yield from expect_close(hurried.arm.gripper, waited.arm.gripper, tolerance, f"the gripper {where}")
                yield from expect_close(hurried.positions, waited.positions, tolerance, f"the objects {where}")


@check
def contacts_are_told_in_order(subject: PhysicsUnderTest) -> Faults:
    """Motion.contacts: first contact of each part of the arm with each object in each phase, in order of time."""
    scene = scene_of(cylinder("ahead", 0.2, 0.2), cylinder("beside", 0.2, 0.35), cylinder("far", 0.55, 0.55))
    with on_stand(subject, scene) as stand:
        motion = stand.run(stand.start, sweep(0.22, 0.2, 0.36)).motion
        contacts = motion.contacts
        times = [contact.time for contact in contacts]
        yield from expect(times == sorted(times), "contacts in order of time", str(times))
        yield from expect(all(0.0 <= time <= motion.duration for time in times), "times within the motion", str(times))
        known = [(contact.body, contact.phase, contact.part) for contact in contacts]
        yield from expect(len(set(known)) == len(known), "one contact for each part, object and phase", str(known))
        found = {(contact.body, contact.phase) for contact in contacts}
        for wanted in (("ahead", Phase.INSERT), ("beside", Phase.SWEEP)):
            yield from expect(
                wanted in found, f"contact with {wanted[0]!r} in the phase {wanted[1]}", str(sorted(found))
            )
        early = {("beside", Phase.INSERT), ("far", Phase.INSERT), ("far", Phase.SWEEP)} & found
        yield from expect(not early, "no contact with what was not touched", str(sorted(early)))
        parts = _parts(subject)
        yield from expect({c.part for c in contacts} <= parts, f"parts among {sorted(parts)}", str(known))


@check
def a_watcher_sees_it_all(subject: PhysicsUnderTest) -> Faults:
    """Watch: a look at the beginning, once in every period, settling included, and at the end."""
    with on_stand(subject, crowd()) as stand:
        for period in (0.05, 0.25):
            film = WatchLog(period)
            made = stand.run(stand.start, CROWD_SWEEP, watch=film.watch)
            times = np.array(film.times)
            if len(times) < 2:
                yield from expect(False, "a look in every period", f"{len(times)} looks")
                continue
            yield from expect_close(times[0], 0.0, 1e-9, "the time of the first look (s)")
            yield from expect_close(times[-1], made.motion.duration, 1e-9, "the time of the last look (s)")
            steps = np.diff(times)
            yield from expect((steps >= 0.0).all(), "looks in order of time", str(times))
            yield from expect_close(float(steps.max()), period, STEP, "the longest time between looks (s)")
            yield from expect_close(len(times), made.motion.duration / period + 2.0, 2.0 + 0.2 * len(times), "looks")
            yield from expect_equal(
                film.states[0].poses.tolist(), stand.start.poses.tolist(), "the objects at the first look"
            )
            yield from expect_equal(film.states[-1], made.state, "the world at the last look")
            between = {tuple(state.poses.ravel()) for state in film.states}
            yield from expect(len(between) > 3, "objects seen on their way", f"{len(between)} different arrangements")


@check
def stops_at_the_first_contact(subject: PhysicsUnderTest) -> Faults:
    """Stop.bodies: the motion ends at the first contact of the arm with any of these objects; the arm stands there."""
    with on_stand(subject, scene_of(cylinder("near", 0.15, MIDDLE), cylinder("far", 0.3, MIDDLE))) as stand:
        trajectory = stand.trajectory(stand.start, drive_in(0.4))
        made = stand.physics.simulate(stand.start, trajectory, stop=Stop(bodies=frozenset({"near"})), settle=None)
        motion, arm = made.motion, made.state.arm
        yield from expect(
            motion.stopped and motion.stopped.body == "near", "stopped, with 'near' as the cause", str(motion)
        )
        yield from expect(not motion.complete, "a motion that was not completed", str(motion))
        yield from expect_close(np.nan if arm is None else arm.gripper[0], 0.12, 0.015, "x of the fingertip (m)")
        left = trajectory.duration - motion.followed
        yield from expect(left > 0.8, "more than 0.8 s not driven: 0.28 m at 0.25 m/s, and more", f"{left:g} s")
        free = stand.run(stand.start, drive_in(0.2), stop=Stop(bodies=frozenset({"far"})))
        yield from expect(free.motion.complete, "no stop before that object is touched", str(free.motion))


@check
def stops_at_a_force(subject: PhysicsUnderTest) -> Faults:
    """Stop.force: the motion ends when the force on the arm is above this."""
    with on_stand(subject, scene_of(cylinder("heavy", 0.2, MIDDLE, mass=4.0, friction=0.5))) as stand:
        motion = stand.run(stand.start, drive_in(0.4), stop=Stop(force=8.0)).motion
        cause = None if motion.stopped is None else motion.stopped.cause
        yield from expect(cause is StopCause.FORCE, "stopped by the force, as 19.6 N are needed", str(motion))
        yield from expect(motion.stopped is None or not motion.stalled, "a stop rather than a stall", str(motion))
        free = stand.run(stand.start, drive_in(0.15), stop=Stop(force=8.0)).motion
        yield from expect(free.complete, "no stop where nothing is touched", str(free))


@check
def stops_at_a_wall(subject: PhysicsUnderTest) -> Faults:
    """Stop.wall: the motion ends at any contact of the arm with a wall."""
    with on_stand(subject, scene_of(cylinder("o", 0.3, 0.5))) as stand:
        made = stand.run(stand.start, sweep(0.3, MIDDLE, 0.0), stop=Stop(wall=True))
        cause = None if made.motion.stopped is None else made.motion.stopped.cause
        yield from expect(cause is StopCause.WALL, "stopped by the south wall", str(made.motion))
        walls = {contact.body for contact in made.motion.wall_contacts}
        yield from expect_equal(walls, {"south wall"}, "the walls touched")


def _from(stand: PhysicsStand, state: State, offset: list[float]) -> Trajectory:
    """A short trajectory that begins a little off where the arm is."""
    assert state.arm is not None
    begin = state.arm.gripper + np.array(offset)
    shifted = ArmState(begin, state.arm.opening, state.arm.command, _joints_at(stand, begin, state.arm.joints))
    end = begin + np.array([0.01, 0.0, 0.0])
    return stand.trajectory(State(state.poses, state.conditions, arm=shifted), path([begin, end], [Phase.INSERT]))


def _joints_at(stand: PhysicsStand, gripper: FloatArray, seed: FloatArray | None) -> FloatArray | None:
    """Joint values near others, where those are known: an arm of many joints has other ones for the same gripper."""
    if seed is None:
        return None
    x, y, yaw = gripper.tolist()
    pose = compose(inverse(stand.base_pose.pose), planar_pose(x, y, stand.arm.shape.height, yaw))
    return stand.arm.inverse(pose, seed)


def _parts(subject: PhysicsUnderTest) -> set[str]:
    arm = subject.arm
    return {outline.part for outline in arm.shape.closed} | {arm.tip_link, *arm.fingers.links} | _links(arm.urdf())


def _links(urdf: str) -> set[str]:
    return {link.get("name", "") for link in ET.fromstring(urdf).findall("link")}


MOTION_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    trajectories_are_followed,
    fingers_open_and_close_as_told,
    execution_goes_on_from_where_the_world_is,
    trajectories_that_begin_elsewhere_are_refused,
    waiting_for_rest_changes_nothing_before,
    contacts_are_told_in_order,
    a_watcher_sees_it_all,
    stops_at_the_first_contact,
    stops_at_a_force,
    stops_at_a_wall,
)
