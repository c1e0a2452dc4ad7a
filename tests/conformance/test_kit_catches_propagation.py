"""Every check of propagation finds a backend that breaks its promise, and none minds a backend that offers no such thing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.backends.pymunk_.state import PymunkSnapshot
from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    Motion,
    Options,
    Physics,
    Scene,
    Settle,
    State,
    Stop,
    Trajectory,
    Watch,
)
from phframe.testing import Check, ConformanceError, NotApplicableError, PhysicsUnderTest
from phframe.testing.check import run_checks
from phframe.testing.physics.propagation import PROPAGATION_CHECKS

ARM = PlanarArm(PlanarArmOptions())


class Altered(PymunkPhysics):
    """A backend whose propagation is altered."""

    def propagate(
        self,
        snapshot: PymunkSnapshot,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[PymunkSnapshot, Motion]:
        start, stop = self.begin(snapshot), self.heeded(stop)
        end, motion = super().propagate(start, self.slowed(np.asarray(twist)), dt, opening=opening, stop=stop)
        return self.end(end), motion

    def begin(self, snapshot: PymunkSnapshot) -> PymunkSnapshot:
        return snapshot

    def slowed(self, twist: FloatArray) -> FloatArray:
        return twist

    def heeded(self, stop: Stop | None) -> Stop | None:
        return stop

    def end(self, snapshot: PymunkSnapshot) -> PymunkSnapshot:
        return snapshot


class Continues(Altered):
    """Goes on from where it is rather than from the snapshot."""

    last: PymunkSnapshot | None = None

    def begin(self, snapshot: PymunkSnapshot) -> PymunkSnapshot:
        return self.last or snapshot

    def end(self, snapshot: PymunkSnapshot) -> PymunkSnapshot:
        self.last = snapshot
        return snapshot


class HalfSpeed(Altered):
    def slowed(self, twist: FloatArray) -> FloatArray:
        return twist / 2.0


class Creeps(Altered):
    def end(self, snapshot: PymunkSnapshot) -> PymunkSnapshot:
        poses = snapshot.state.poses + np.array([1e-3, 0, 0, 0, 0, 0, 0])
        return replace(snapshot, state=replace(snapshot.state, poses=poses))


class WithoutSpeeds(Altered):
    def end(self, snapshot: PymunkSnapshot) -> PymunkSnapshot:
        return replace(snapshot, velocities=0.0 * snapshot.velocities)


class LooksAtTheWorld(Altered):
    def state_of(self, snapshot: PymunkSnapshot) -> State:
        return self.observe()


class NeverStops(Altered):
    def heeded(self, stop: Stop | None) -> Stop | None:
        return None


class NeedsNoArm(PymunkPhysics):
    def propagate(
        self,
        snapshot: PymunkSnapshot,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[PymunkSnapshot, Motion]:
        if snapshot.state.arm is None:
            return snapshot, Motion(dt)
        return super().propagate(snapshot, twist, dt, opening=opening, stop=stop)


class OffersNone(Physics[Options]):
    """A backend with the bare interface."""

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose) -> None:
        super().__init__(scene, arm, base_pose, Options())
        self._inside = PymunkPhysics(scene, arm, base_pose, PymunkOptions())

    def restore(self, state: State) -> State:
        return self._inside.restore(state)

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        return self._inside.execute(trajectory, settle=settle, stop=stop, watch=watch)

    def observe(self) -> State:
        return self._inside.observe()

    def close(self) -> None:
        self._inside.close()


BROKEN: dict[str, type[PymunkPhysics]] = {
    "propagation_is_pure": Continues,
    "propagation_moves_the_fingertip": HalfSpeed,
    "no_twist_changes_nothing": Creeps,
    "snapshots_keep_speeds": WithoutSpeeds,
    "snapshots_are_what_the_world_is": LooksAtTheWorld,
    "propagation_stops_when_told": NeverStops,
    "propagation_needs_an_arm": NeedsNoArm,
}


@pytest.mark.parametrize("check", PROPAGATION_CHECKS, ids=lambda check: check.name)
def test_every_check_can_fail(check: Check[PhysicsUnderTest]) -> None:
    backend = BROKEN[check.name]
    with pytest.raises(ConformanceError) as caught:
        check(PhysicsUnderTest(lambda s, a, m: backend(s, a, m, PymunkOptions()), ARM))
    assert "no exception" not in str(caught.value)


def test_what_is_not_offered_is_reported_as_such() -> None:
    subject = PhysicsUnderTest(OffersNone, ARM, name="bare")
    report = run_checks(subject, PROPAGATION_CHECKS)
    assert report.passed == ()
    assert dict(report.not_applicable) == {
        check.name: "bare does not offer propagation" for check in PROPAGATION_CHECKS
    }
    with pytest.raises(NotApplicableError):
        PROPAGATION_CHECKS[0](subject)
