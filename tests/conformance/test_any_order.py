"""Restore, execute, observe and simulate in any order: what a backend holds depends on what was asked of it since, alone."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule, run_state_machine_as_test

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import GripperPath, Motion, Physics, Settle, State, Trajectory
from phframe.registry import Kind, load
from phframe.testing import PhysicsUnderTest
from phframe.testing.physics.paths import CROWD_SWEEP, crowd, drive_in, grasp, sweep
from phframe.testing.physics.stand import PhysicsStand

ARM = PlanarArm(PlanarArmOptions())
PATHS = (CROWD_SWEEP, sweep(0.28, 0.45, 0.25), drive_in(0.12), drive_in(0.3, 0.33), grasp(ARM, 0.5))
SETTLE = Settle()


class AnyOrder(RuleBasedStateMachine):
    """A backend that is used, beside what was asked of it, which a new one repeats."""

    backend: ClassVar[str]

    def __init__(self) -> None:
        super().__init__()
        self.stand = self.new()
        self.states = [self.stand.start]
        self.begun: State | None = None
        self.driven: list[tuple[Trajectory, Motion]] = []

    def new(self) -> PhysicsStand:
        kind = load(Kind.BACKEND, self.backend)
        subject = PhysicsUnderTest(lambda *of: kind(*of, kind.options_type()), ARM, name=self.backend)
        return PhysicsStand(subject, crowd())

    @property
    def physics(self) -> Physics[Any]:
        return self.stand.physics

    @rule(data=st.data())
    def restore(self, data: st.DataObject) -> None:
        self.begun = data.draw(st.sampled_from(self.states))
        assert self.physics.restore(self.begun) == self.physics.observe()
        self.driven = []

    @precondition(lambda self: self.begun is not None)
    @rule(path=st.sampled_from(PATHS))
    def execute(self, path: GripperPath) -> None:
        trajectory = self.stand.trajectory(self.physics.observe(), path)
        self.driven.append((trajectory, self.physics.execute(trajectory, settle=SETTLE)))
        self.states.append(self.physics.observe())

    @rule(path=st.sampled_from(PATHS), data=st.data())
    def simulate(self, path: GripperPath, data: st.DataObject) -> None:
        self.begun = data.draw(st.sampled_from(self.states))
        trajectory = self.stand.trajectory(self.begun, path)
        made = self.physics.simulate(self.begun, trajectory, settle=SETTLE)
        self.driven = [(trajectory, made.motion)]
        assert made.state == self.physics.observe()
        self.states.append(made.state)

    @rule()
    def close(self) -> None:
        self.physics.close()
        self.physics.close()
        self.begun, self.driven = None, []

    @precondition(lambda self: self.begun is not None)
    @rule()
    def a_new_one_comes_to_the_same(self) -> None:
        assert self.begun is not None
        other = self.new().physics
        try:
            other.restore(self.begun)
            for trajectory, motion in self.driven:
                assert other.execute(trajectory, settle=SETTLE) == motion
            assert other.observe() == self.physics.observe()
        finally:
            other.close()

    @invariant()
    def looking_changes_nothing(self) -> None:
        if self.begun is not None:
            assert self.physics.observe() == self.physics.observe()

    def teardown(self) -> None:
        self.physics.close()


MARKS = {
    "pymunk": (),
    "fast": (),
    "mujoco": (pytest.mark.needs_mujoco,),
    "pybullet": (pytest.mark.needs_pybullet,),
}
LIBRARIES = {"fast": "numba"}


@pytest.mark.slow
@pytest.mark.parametrize("backend", [pytest.param(name, marks=marks) for name, marks in MARKS.items()])
def test_in_any_order(backend: str) -> None:
    pytest.importorskip(LIBRARIES.get(backend, backend))
    machine = type(f"AnyOrderIn{backend.title()}", (AnyOrder,), {"backend": backend})
    few, short = (5, 8) if backend in ("pymunk", "fast") else (3, 6)
    run_state_machine_as_test(machine, settings=settings(max_examples=few, stateful_step_count=short, deadline=None))
