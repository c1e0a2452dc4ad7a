"""What is particular to the pymunk backend; that it keeps to the interface is checked in tests/conformance."""

from __future__ import annotations

import pickle
import subprocess
import sys

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.core import JointTrajectory, OptionError
from phframe.testing import PHYSICS_CHECKS, PhysicsUnderTest
from phframe.testing.physics.paths import CROWD_SWEEP, MIDDLE, crowd, cylinder, drive_in, scene_of
from phframe.testing.physics.stand import on_stand

ARM = PlanarArm(PlanarArmOptions())

TRANSITION_IN_A_NEW_PROCESS = """
import pickle, sys
from tests.backends.test_pymunk import swept
sys.stdout.buffer.write(pickle.dumps(swept()))
"""


def subject(options: PymunkOptions | None = None) -> PhysicsUnderTest:
    chosen = options or PymunkOptions()
    return PhysicsUnderTest(lambda s, a, m: PymunkPhysics(s, a, m, chosen), ARM, name="pymunk")


def swept() -> object:
    with on_stand(subject(), crowd()) as stand:
        return stand.run(stand.start, CROWD_SWEEP)


def test_another_process_gives_the_same_bits() -> None:
    command = [sys.executable, "-c", TRANSITION_IN_A_NEW_PROCESS]
    done = subprocess.run(command, capture_output=True, check=True, timeout=60)
    assert pickle.loads(done.stdout) == swept()


@pytest.mark.parametrize(
    "options",
    [
        PymunkOptions(step=1.0 / 480.0),
        PymunkOptions(step=1.0 / 240.0, iterations=30),
        PymunkOptions(arm_mass=20.0, arm_friction=0.8, object_friction=0.6),
    ],
    ids=["finer steps", "more iterations", "a heavy rough arm"],
)
@pytest.mark.parametrize(
    "name", ["walls_hold_what_is_pressed_into_them", "nothing_passes_through_anything", "runs_forget_what_ran_before"]
)
def test_it_holds_with_other_options(options: PymunkOptions, name: str) -> None:
    check = next(check for check in PHYSICS_CHECKS if check.name == name)
    check(subject(options))


def test_objects_stay_where_several_are_pressed_into_a_corner() -> None:
    scene = scene_of(
        *(cylinder(f"o{row}{i}", 0.4 + 0.062 * row, 0.035 + 0.062 * i) for row in range(3) for i in range(4))
    )
    with on_stand(subject(), scene) as stand:
        state = stand.run(stand.start, drive_in(0.5, 0.1)).state
        radius = 0.03
        assert state.on_board.all()
        assert (state.positions[:, 0] <= 0.6 - radius + 2e-3).all()
        assert (state.positions[:, 1] >= radius - 2e-3).all()


def test_a_push_off_centre_turns_an_object_aside() -> None:
    for offset in (0.012, -0.012):
        with on_stand(subject(), scene_of(cylinder("o", 0.2, MIDDLE + offset))) as stand:
            state = stand.run(stand.start, drive_in(0.3)).state
            moved = state.positions[0] - stand.start.positions[0]
            assert np.sign(moved[1]) == np.sign(offset)
            assert moved[0] > 0.02


class ByJoints(PymunkPhysics):
    """pymunk as if it executed joints, to try the way from gripper paths to joints."""

    executes = JointTrajectory  # type: ignore[assignment]


@pytest.mark.parametrize(
    "check", [check for check in PHYSICS_CHECKS if "grasp" in check.name or "walls" in check.name], ids=lambda c: c.name
)
def test_checks_can_be_run_on_backends_that_execute_joints(check: object) -> None:
    by_joints = PhysicsUnderTest(lambda s, a, m: ByJoints(s, a, m, PymunkOptions()), ARM, name="pymunk by joints")
    check(by_joints)  # type: ignore[operator]


@pytest.mark.parametrize("given", [{"step": "0"}, {"iterations": "1000"}, {"gravity": "3"}])
def test_bad_options_are_told(given: dict[str, str]) -> None:
    with pytest.raises(OptionError, match="backend pymunk"):
        PymunkOptions.parse(given, "backend pymunk")
