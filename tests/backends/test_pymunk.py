"""What is particular to the pymunk backend; that it keeps to the interface is checked in tests/conformance."""

from __future__ import annotations

import gc
import pickle
import subprocess
import sys
from weakref import ref

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.backends.pymunk_.state import set_in_motion
from phframe.backends.pymunk_.world import lay_floor
from phframe.core import FloatArray, JointTrajectory, OptionError, Phase, Settle, State, Stop, StopCause
from phframe.testing import PHYSICS_CHECKS, PhysicsUnderTest
from phframe.testing.physics.paths import CROWD_SWEEP, MIDDLE, crowd, cylinder, drive_in, grasp, path, scene_of
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


def _gripper(state: State) -> FloatArray:
    assert state.arm is not None
    return state.arm.gripper


@pytest.mark.parametrize("mass", [0.3, 4.0])
@pytest.mark.parametrize("fast", [True, False], ids=["fast-forwarded", "stepped"])
def test_what_is_held_drags_along_the_board(mass: float, fast: bool) -> None:
    """Coulomb's mu m g, in the shelf; a moving object somewhere keeps the arm from being fast-forwarded."""
    other = cylinder("other", 0.45, 0.5, friction=0.25 if fast else 0.01)
    with on_stand(subject(), scene_of(other, cylinder("target", 0.25, MIDDLE, mass=mass))) as stand:
        gripped = stand.run(stand.start, grasp(ARM, 0.25, withdraw=False)).state
        physics = stand.physics
        assert isinstance(physics, PymunkPhysics)
        physics.restore(gripped)
        if not fast:
            set_in_motion(physics._current, np.array([[0.0, -0.05, 0.0], [0.0, 0.0, 0.0]]))
        out = path(np.array([_gripper(gripped), [0.1, MIDDLE, 0.0]]), [Phase.WITHDRAW], speed=0.2)
        motion = physics.execute(stand.trajectory(gripped, out), settle=None)
        assert motion.complete
        assert motion.largest_force == pytest.approx(0.25 * mass * 9.81, rel=0.05)
        assert stand.center(physics.observe(), "target") == pytest.approx([0.08, MIDDLE], abs=1e-3)


def test_a_stop_at_a_force_counts_what_is_dragged() -> None:
    with on_stand(
        subject(), scene_of(cylinder("other", 0.45, 0.5), cylinder("target", 0.25, MIDDLE, mass=4.0))
    ) as stand:
        motion = stand.run(stand.start, grasp(ARM, 0.25), stop=Stop(force=8.0)).motion
        assert motion.stopped is not None
        assert motion.stopped.cause is StopCause.FORCE
        assert motion.stopped.force == pytest.approx(8.0, rel=0.3)


def test_a_held_object_has_no_board_under_it_outside() -> None:
    with on_stand(subject(), scene_of(cylinder("other", 0.45, 0.5), cylinder("target", 0.25, MIDDLE))) as stand:
        out = stand.run(stand.start, grasp(ARM, 0.25)).state
        physics = stand.physics
        assert isinstance(physics, PymunkPhysics)
        for state in (out, physics.restore(out)):
            assert state.held == "target"
            assert not physics._current.items["target"].on_board
        back = path(np.array([_gripper(out), [0.2, MIDDLE, 0.0]]), [Phase.PLACE])
        physics.execute(stand.trajectory(out, back), settle=None)
        assert physics._current.items["target"].on_board, "carried in again"


def test_control_level_steering_does_not_brake() -> None:
    """A twist is held to its end, whatever the arm does at the corners of a path."""
    ends = []
    for options in (PymunkOptions(), PymunkOptions(arm_acceleration=1.0)):
        with on_stand(subject(options), scene_of(cylinder("o", 0.15, MIDDLE))) as stand:
            physics = stand.physics
            assert isinstance(physics, PymunkPhysics)
            physics.restore(stand.run(stand.start, drive_in(0.05)).state)
            end, _ = physics.propagate(physics.snapshot(), np.array([0.3, 0.0, 0.0]), 0.3)
            ends.append(end.velocities)
    assert ends[0].any(), "it is pushed at the end"
    assert ends[1].tolist() == ends[0].tolist()


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


@pytest.mark.parametrize("standing", [None, 2 / 3])
def test_friction_that_is_there_from_the_beginning_changes_no_bit(standing: float | None) -> None:
    """Objects get it just before something can touch them, since its joints are most of what a step costs."""
    with on_stand(subject(PymunkOptions(standing_radius=standing)), crowd()) as stand:
        physics = stand.physics
        assert isinstance(physics, PymunkPhysics)
        later = stand.run(stand.start, CROWD_SWEEP).state
        assert not all(item.floor for item in physics._current.items.values()), "some were out of reach all the time"
        physics.restore(stand.start)
        for item in physics._current.items.values():
            lay_floor(physics._current, item)
        physics.execute(stand.trajectory(stand.start, CROWD_SWEEP), settle=Settle())
        assert physics.observe() == later
        assert stand.start.displacement(later).max() > 0.05, "much was pushed"


def test_a_world_is_given_back_as_soon_as_the_next_is_built() -> None:
    """Without the help of Python's collector of cycles, which lets hundreds of them pile up."""
    with on_stand(subject(), crowd()) as stand:
        physics = stand.physics
        assert isinstance(physics, PymunkPhysics)
        stand.run(stand.start, CROWD_SWEEP)
        left = ref(physics._current.space)
        gc.disable()
        try:
            physics.restore(stand.start)
            assert left() is None
        finally:
            gc.enable()
