"""Checks of ``SupportsPropagation``, which a backend is free to offer."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np

from phframe.core import ArmError, Stop, SupportsPropagation
from phframe.testing.check import Check, Faults, NotApplicableError, check
from phframe.testing.expect import expect, expect_at_most, expect_close, expect_equal, expect_raises
from phframe.testing.physics.paths import MIDDLE, crowd, cylinder, drive_in, scene_of
from phframe.testing.physics.stand import PhysicsStand, on_stand
from phframe.testing.subjects import PhysicsUnderTest

AHEAD = np.array([0.1, 0.0, 0.0])


@check
def propagation_is_pure(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation.propagate: pure; a snapshot is immutable."""
    with on_stand(subject, crowd()) as stand:
        begin, backend = _snapshot(stand), _backend(stand)
        before = stand_state = backend.state_of(begin)
        first = backend.propagate(begin, AHEAD, 0.5)
        wanted = backend.state_of(first[0])
        for disturbance in (np.array([0.0, 0.1, 0.0]), np.array([0.1, -0.1, 0.5]), AHEAD):
            backend.propagate(begin, disturbance, 0.3)
            again, motion = backend.propagate(begin, AHEAD, 0.5)
            yield from expect_equal(backend.state_of(again), wanted, "the same State again")
            yield from expect_equal(motion, first[1], "the same Motion again")
        yield from expect_equal(backend.state_of(begin), before, "the snapshot as it was")
        yield from expect_equal(stand_state, before, "its state as it was")


@check
def propagation_moves_the_fingertip(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation.propagate: hold a fingertip twist (m/s, m/s, rad/s, shelf frame) for dt seconds."""
    with on_stand(subject, scene_of(cylinder("o", 0.5, 0.5))) as stand:
        begin, backend = _snapshot(stand), _backend(stand)
        place = _tip(backend.state_of(begin))
        for twist in (AHEAD, np.array([0.05, -0.08, 0.2]), np.array([0.0, 0.0, -0.3])):
            end, motion = backend.propagate(begin, twist, 0.5)
            moved = _tip(backend.state_of(end)) - place
            yield from expect_close(
                moved, twist * 0.5, 2.0 * subject.tolerances.tracking, f"the way of {twist} in 0.5 s"
            )
            yield from expect_close(motion.duration, 0.5, 0.02, "the duration (s)")


@check
def no_twist_changes_nothing(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation.propagate: what is at rest stays at rest."""
    with on_stand(subject, crowd()) as stand:
        begin, backend = _snapshot(stand), _backend(stand)
        end, _ = backend.propagate(begin, np.zeros(3), 1.0)
        before, after = backend.state_of(begin), backend.state_of(end)
        moved = float(np.abs(after.poses[:, :3] - before.poses[:, :3]).max())
        yield from expect_at_most(moved, subject.tolerances.untouched, "how far anything moves in 1 s (m)")


@check
def snapshots_keep_speeds(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation: unlike a State, a snapshot holds speeds; a pushed object slides on in the next step."""
    with on_stand(subject, scene_of(cylinder("o", 0.2, MIDDLE, friction=0.15))) as stand:
        backend = _backend(stand)
        pushed, _ = backend.propagate(_snapshot(stand), np.array([0.4, 0.0, 0.0]), 0.5)
        after, _ = backend.propagate(pushed, np.zeros(3), 0.5)
        slid = float(backend.state_of(after).poses[0, 0] - backend.state_of(pushed).poses[0, 0])
        yield from expect(slid > 0.02, "an object at 0.4 m/s to slide on", f"it slid {slid:.4f} m")


@check
def snapshots_are_what_the_world_is(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation.snapshot: the world as it is now; state_of: what it holds, its speeds aside."""
    with on_stand(subject, crowd()) as stand:
        begin, backend = _snapshot(stand), _backend(stand)
        yield from expect_equal(backend.state_of(begin), stand.physics.observe(), "the state of a snapshot")
        before = pickle.dumps(backend.state_of(begin))
        stand.run(stand.start, drive_in(0.4))
        yield from expect(
            pickle.dumps(backend.state_of(begin)) == before, "a snapshot as it was after a run", "it changed"
        )


@check
def propagation_stops_when_told(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation.propagate: when to end early."""
    with on_stand(subject, scene_of(cylinder("o", 0.2, MIDDLE))) as stand:
        backend = _backend(stand)
        _, motion = backend.propagate(_snapshot(stand), AHEAD, 2.0, stop=Stop(bodies=frozenset({"o"})))
        yield from expect(motion.stopped is not None and motion.duration < 1.6, "stopped at the contact", str(motion))


@check
def propagation_needs_an_arm(subject: PhysicsUnderTest) -> Faults:
    """SupportsPropagation.propagate raises ArmError if the arm is parked."""
    with on_stand(subject, crowd()) as stand:
        backend = _backend(stand)
        stand.physics.restore(stand.start)
        parked = backend.snapshot()
        yield from expect_raises(ArmError, lambda: backend.propagate(parked, AHEAD, 0.1), "a parked arm")


def _backend(stand: PhysicsStand) -> SupportsPropagation[Any]:
    if not isinstance(stand.physics, SupportsPropagation):
        raise NotApplicableError(f"{stand.subject.name} does not offer propagation")
    return stand.physics


def _snapshot(stand: PhysicsStand) -> Any:
    """The world at rest with the fingertip 5 cm inside the mouth."""
    backend = _backend(stand)
    stand.physics.restore(stand.run(stand.start, drive_in(0.05)).state)
    return backend.snapshot()


def _tip(state: Any) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.full(3, np.nan) if state.arm is None else np.asarray(state.arm.gripper)


PROPAGATION_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    propagation_is_pure,
    propagation_moves_the_fingertip,
    no_twist_changes_nothing,
    snapshots_keep_speeds,
    snapshots_are_what_the_world_is,
    propagation_stops_when_told,
    propagation_needs_an_arm,
)
