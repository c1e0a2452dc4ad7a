"""Every check of many simulations finds a backend that breaks its promise, and none minds one that offers no such thing."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.core import Settle, State, Stop, Trajectory, Transition
from phframe.testing import Check, ConformanceError, NotApplicableError, PhysicsUnderTest
from phframe.testing.physics.many import MANY_CHECKS

ARM = PlanarArm(PlanarArmOptions())


class OneByOne(PymunkPhysics):
    """A backend that keeps the promise, in the simplest way."""

    def simulate_many(
        self,
        states: Sequence[State],
        trajectories: Sequence[Trajectory],
        *,
        settle: Settle | None = Settle(),  # noqa: B008 - immutable
        stop: Stop | None = None,
    ) -> list[Transition]:
        pairs = zip(states, trajectories, strict=True)
        return [self.simulate(state, trajectory, settle=settle, stop=stop) for state, trajectory in pairs]


class Backwards(OneByOne):
    """Mixes them up, and makes something of nothing."""

    def simulate_many(
        self, states: Sequence[State], trajectories: Sequence[Trajectory], **how: object
    ) -> list[Transition]:
        found = super().simulate_many(states, trajectories, **how)[::-1]  # type: ignore[arg-type]
        return found or super().simulate_many([self.scene.initial_state()], [self._still()])

    def _still(self) -> Trajectory:
        from phframe.core import time_path
        from phframe.testing.physics.paths import drive_in

        return time_path(drive_in(0.0), 0.0, 60.0)


class Deaf(OneByOne):
    """Does not stop when told."""

    def simulate_many(
        self, states: Sequence[State], trajectories: Sequence[Trajectory], **how: object
    ) -> list[Transition]:
        return super().simulate_many(states, trajectories)


def under_test(kind: type[PymunkPhysics]) -> PhysicsUnderTest:
    return PhysicsUnderTest(lambda scene, arm, pose: kind(scene, arm, pose, PymunkOptions()), ARM, name=kind.__name__)


each_check = pytest.mark.parametrize("check", MANY_CHECKS, ids=lambda check: check.name)


@each_check
def test_a_backend_that_keeps_the_promise_passes(check: Check[PhysicsUnderTest]) -> None:
    check(under_test(OneByOne))


@each_check
def test_one_that_mixes_them_up_is_found(check: Check[PhysicsUnderTest]) -> None:
    with pytest.raises(ConformanceError):
        check(under_test(Backwards))


def test_one_that_does_not_stop_is_found() -> None:
    with pytest.raises(ConformanceError):
        MANY_CHECKS[0](under_test(Deaf))


@each_check
def test_one_that_offers_no_such_thing_is_not_asked(check: Check[PhysicsUnderTest]) -> None:
    with pytest.raises(NotApplicableError):
        check(under_test(PymunkPhysics))
