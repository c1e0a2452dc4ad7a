"""Checks that a backend is pure where it must be, and changes nothing that is not its own."""

from __future__ import annotations

import pickle
from collections.abc import Iterator

import numpy as np

from phframe.core import Phase, Settle, State, Trajectory, Transition
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_equal
from phframe.testing.physics.paths import CROWD_SWEEP, crowd, cylinder, drive_in, grasp, path, scene_of, sweep
from phframe.testing.physics.stand import PhysicsStand, WatchLog, on_stand
from phframe.testing.subjects import PhysicsUnderTest

SECOND_SWEEP = sweep(0.42, 0.42, 0.25)


@check
def runs_repeat_bit_by_bit(subject: PhysicsUnderTest) -> Faults:
    """Physics: simulate(s, t) depends on s and t alone, the same bits every time."""
    with on_stand(subject, crowd()) as stand:
        for state, trajectory, what in _cases(stand):
            first = stand.physics.simulate(state, trajectory)
            for _ in range(subject.tolerances.repeatedly):
                yield from _expect_same(stand.physics.simulate(state, trajectory), first, f"{what}, again")


@check
def runs_forget_what_ran_before(subject: PhysicsUnderTest) -> Faults:
    """Physics: simulate(s, t) gives the same bits whatever ran before, executions and other worlds included."""
    with on_stand(subject, crowd()) as stand, on_stand(subject, scene_of(cylinder("o", 0.2, 0.3))) as other:
        cases = list(_cases(stand))
        first = [stand.physics.simulate(state, trajectory) for state, trajectory, _ in cases]
        for (state, trajectory, what), wanted in reversed(list(zip(cases, first, strict=True))):
            for disturbance in _disturbances(stand, other):
                found = stand.physics.simulate(state, trajectory)
                yield from _expect_same(found, wanted, f"{what}, after {disturbance}")


@check
def new_backends_give_the_same_bits(subject: PhysicsUnderTest) -> Faults:
    """Physics: simulate(s, t) depends on s and t alone, not on which instance is asked."""
    with on_stand(subject, crowd()) as stand:
        for state, trajectory, what in _cases(stand):
            first = stand.physics.simulate(state, trajectory)
            with on_stand(subject, crowd()) as new:
                yield from _expect_same(new.physics.simulate(state, trajectory), first, f"{what}, in a new backend")


@check
def arguments_are_not_changed(subject: PhysicsUnderTest) -> Faults:
    """Data is immutable: scene, state and trajectory are the same after a run as before."""
    with on_stand(subject, crowd()) as stand:
        for state, trajectory, what in _cases(stand):
            before = pickle.dumps((stand.scene, state, trajectory))
            stand.physics.simulate(state, trajectory)
            after = pickle.dumps((stand.scene, state, trajectory))
            yield from expect(after == before, f"scene, state and trajectory as they were, {what}", "they changed")


@check
def results_do_not_change_later(subject: PhysicsUnderTest) -> Faults:
    """State: immutable; what was returned once does not follow the world afterwards."""
    with on_stand(subject, crowd()) as stand:
        cases = list(_cases(stand))
        results: list[tuple[object, bytes]] = []
        for state, trajectory, _ in cases:
            made = stand.physics.simulate(state, trajectory), stand.physics.observe()
            results.extend((result, pickle.dumps(result)) for result in made)
        for result, bits in results:
            yield from expect(pickle.dumps(result) == bits, "a result as it was before other runs", "it changed")


@check
def watching_changes_nothing(subject: PhysicsUnderTest) -> Faults:
    """Watch: watching never changes what happens."""
    with on_stand(subject, crowd()) as stand:
        for state, trajectory, what in _cases(stand):
            unseen = stand.physics.simulate(state, trajectory)
            for period in (1e-3, 1.0 / 30.0, 10.0):
                found = stand.physics.simulate(state, trajectory, watch=WatchLog(period).watch)
                yield from _expect_same(found, unseen, f"{what}, watched every {period:g} s")


@check
def observing_changes_nothing(subject: PhysicsUnderTest) -> Faults:
    """Physics.observe: the world as it is now; looking twice gives the same, and a run goes on as if nobody had looked."""
    with on_stand(subject, crowd()) as stand:
        ends = []
        for looks in (0, 3):
            stand.physics.restore(stand.start)
            stand.physics.execute(stand.trajectory(stand.start, drive_in(0.3)), settle=None)
            seen = [stand.physics.observe() for _ in range(looks)]
            yield from expect(len(set(seen)) <= 1, "the same state at every look", f"{len(set(seen))} different ones")
            trajectory = stand.standing_still(stand.physics.observe(), 0.3)
            stand.physics.execute(trajectory, settle=Settle())
            ends.append(stand.physics.observe())
        yield from expect_equal(ends[1], ends[0], "the world after a run in which somebody looked")


def _cases(stand: PhysicsStand) -> Iterator[tuple[State, Trajectory, str]]:
    """States and trajectories: the first push, a push from where the arm was left, a stopped arm, a held target."""
    yield stand.start, stand.trajectory(stand.start, CROWD_SWEEP), "a first sweep"
    pushed = stand.run(stand.start, CROWD_SWEEP).state
    yield pushed, stand.trajectory(pushed, SECOND_SWEEP), "a sweep from where the first one ended"
    inside = stand.run(stand.start, drive_in(0.25, 0.2), settle=None).state
    back = path([[0.25, 0.2, 0.0], [0.25, 0.35, 0.0]], [Phase.SWEEP])
    yield inside, stand.trajectory(inside, back), "a sweep that begins inside the shelf"
    lone = State(np.array(_moved_aside(stand)), stand.start.conditions)
    yield lone, stand.trajectory(lone, grasp(stand.arm, 0.5)), "a grasp"


def _moved_aside(stand: PhysicsStand) -> list[list[float]]:
    """Poses with all but the target along the walls."""
    poses: list[list[float]] = stand.start.poses.tolist()
    for row, y in enumerate((0.05, 0.12, 0.48, 0.55)):
        poses[row][1] = y
    return poses


def _disturbances(stand: PhysicsStand, other: PhysicsStand) -> Iterator[str]:
    physics = stand.physics
    stand.run(stand.start, SECOND_SWEEP)
    yield "another sweep"
    stand.run(stand.start, CROWD_SWEEP, force_limit=1.0)
    yield "a sweep that stalled"
    physics.restore(stand.start)
    physics.execute(stand.trajectory(stand.start, drive_in(0.3)), settle=None)
    yield "an execution left unfinished"
    physics.observe()
    other.run(other.start, drive_in(0.3))
    yield "a run in another world"


def _expect_same(found: Transition, wanted: Transition, what: str) -> Faults:
    yield from expect_equal(found.state, wanted.state, f"the same State for {what}")
    yield from expect_equal(found.motion, wanted.motion, f"the same Motion for {what}")


PURITY_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    runs_repeat_bit_by_bit,
    runs_forget_what_ran_before,
    new_backends_give_the_same_bits,
    arguments_are_not_changed,
    results_do_not_change_later,
    watching_changes_nothing,
    observing_changes_nothing,
)
