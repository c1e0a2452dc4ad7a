"""Checks of ``SupportsManySimulations``, which a backend is free to offer."""

from __future__ import annotations

from phframe.core import State, Stop, SupportsManySimulations, Trajectory
from phframe.testing.check import Check, Faults, NotApplicableError, check
from phframe.testing.expect import expect_equal
from phframe.testing.physics.paths import CROWD_SWEEP, crowd, drive_in, grasp, sweep
from phframe.testing.physics.stand import PhysicsStand, on_stand
from phframe.testing.subjects import PhysicsUnderTest


@check
def many_simulations_are_as_one_by_one(subject: PhysicsUnderTest) -> Faults:
    """SupportsManySimulations.simulate_many: simulate of each state and its trajectory, in their order, the same bits."""
    with on_stand(subject, crowd()) as stand:
        backend, (states, trajectories) = _backend(stand), _cases(stand)
        for stop in (None, Stop(bodies=frozenset({"a", "b"}))):
            alone = [
                stand.physics.simulate(state, trajectory, stop=stop)
                for state, trajectory in zip(states, trajectories, strict=True)
            ]
            together = backend.simulate_many(states, trajectories, stop=stop)
            yield from expect_equal(len(together), len(alone), "the number of transitions")
            for row, (found, wanted) in enumerate(zip(together, alone, strict=False)):
                yield from expect_equal(found.state, wanted.state, f"the State of motion {row}")
                yield from expect_equal(found.motion, wanted.motion, f"the Motion of motion {row}")


@check
def no_simulations_are_none(subject: PhysicsUnderTest) -> Faults:
    """SupportsManySimulations.simulate_many: one transition for each trajectory."""
    with on_stand(subject, crowd()) as stand:
        yield from expect_equal(_backend(stand).simulate_many([], []), [], "what becomes of nothing")


def _backend(stand: PhysicsStand) -> SupportsManySimulations:
    if not isinstance(stand.physics, SupportsManySimulations):
        raise NotApplicableError(f"{stand.subject.name} does not offer many simulations at once")
    return stand.physics


def _cases(stand: PhysicsStand) -> tuple[list[State], list[Trajectory]]:
    pushed = stand.run(stand.start, CROWD_SWEEP).state
    ways = (CROWD_SWEEP, drive_in(0.4), sweep(0.3, 0.5, 0.1), grasp(stand.arm, 0.5))
    cases = [(stand.start, stand.trajectory(stand.start, way)) for way in ways]
    cases.append((pushed, stand.trajectory(pushed, sweep(0.42, 0.42, 0.25))))
    return [state for state, _ in cases], [trajectory for _, trajectory in cases]


MANY_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (many_simulations_are_as_one_by_one, no_simulations_are_none)
