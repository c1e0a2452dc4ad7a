"""The planar arm's motion planner: timed joints along a gripper's path."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import (
    ArmState,
    BasePose,
    Contacts,
    Cylinder,
    FloatArray,
    GripperPath,
    JointTrajectory,
    Phase,
    PhaseRule,
    Scene,
    SceneObject,
    Shelf,
    State,
    Unreachable,
    compose,
    yaw_of,
)
from phframe.motion.planar import PlanarMotionOptions, PlanarMotionPlanner
from phframe.motion.trapezoidal_velocity import trapezoidal_profile

ARM = PlanarArm(PlanarArmOptions())
SCENE = Scene("s", Shelf(0.6, 0.6), (SceneObject("target", Cylinder(0.03), (0.5, 0.3)),), "target")
RULES = {
    Phase.INSERT: PhaseRule(0.25, 0.0, Contacts.OBJECTS),
    Phase.SWEEP: PhaseRule(0.2, 0.0, Contacts.OBJECTS),
    Phase.GRASP: PhaseRule(0.2, 0.08, Contacts.MANIPULAND),
}
POSES = np.array([[-0.05, 0.2, 0.1], [0.3, 0.25, 0.1], [0.3, 0.4, -0.2], [0.3, 0.4, -0.2]])
PATH = GripperPath(POSES, (Phase.INSERT, Phase.SWEEP, Phase.GRASP), RULES, "target")


def planned(path: GripperPath, state: State, base_pose: BasePose) -> JointTrajectory | Unreachable:
    planner = PlanarMotionPlanner(SCENE, ARM, base_pose, PlanarMotionOptions())
    return planner.plan(path, state, attempts=1, seconds=1.0, rng=np.random.default_rng(0))


def seen(q: FloatArray, base_pose: BasePose) -> list[float]:
    pose = compose(base_pose.pose, ARM.forward(q))
    return [pose[0], pose[1], yaw_of(pose)]


@pytest.mark.parametrize(
    "base_pose", [BasePose(-0.1, 0.3, 0.06, 0.0), BasePose(-0.4, 0.1, 0.06, 0.7)], ids=["straight", "turned"]
)
def test_the_fingertip_follows_the_path(base_pose: BasePose) -> None:
    trajectory = planned(PATH, SCENE.initial_state(), base_pose)
    assert isinstance(trajectory, JointTrajectory)
    assert trajectory.positions[0].tolist() == ARM.home.tolist()
    for q, pose in zip(trajectory.positions, trajectory.gripper.poses, strict=True):
        assert np.allclose(seen(q, base_pose), pose, atol=1e-9)
    corners = [leg for leg, phase in enumerate(trajectory.gripper.phases) if phase is not Phase.APPROACH]
    ends = trajectory.gripper.poses[[corners[0], -1]]
    assert np.allclose(ends, POSES[[0, -1]], atol=1e-9)
    assert trajectory.gripper.openings[-1] == pytest.approx(0.08)
    sweep = trajectory.gripper.poses[[phase is Phase.SWEEP for phase in trajectory.gripper.phases] + [False]]
    way = POSES[2] - POSES[1]
    fraction = (sweep - POSES[1]) @ way / (way @ way)
    assert np.allclose(sweep, POSES[1] + fraction[:, None] * way, atol=1e-9)


def test_it_rests_at_corners_and_keeps_to_speeds_and_accelerations() -> None:
    base_pose, options = BasePose(-0.4, 0.1, 0.06, 0.7), PlanarMotionOptions()
    trajectory = planned(PATH, SCENE.initial_state(), base_pose)
    assert isinstance(trajectory, JointTrajectory)
    phases = trajectory.gripper.phases
    changes = [0, *(leg for leg in range(1, len(phases)) if phases[leg] is not phases[leg - 1]), len(phases)]
    assert not trajectory.velocities[changes].any()
    times = np.linspace(0.0, trajectory.duration, 20001)
    positions, speeds = trajectory.sample(times)
    tip = np.hypot(speeds[:, 0], speeds[:, 1])
    for time, speed in zip(times[::20], tip[::20], strict=True):
        phase = trajectory.gripper.phase_at(float(time))
        limit = RULES[phase].speed if phase in RULES else options.approach_speed
        assert speed <= limit * (1.0 + 1e-9)
    pace = np.gradient(positions, times, axis=0)
    assert np.allclose(pace, speeds, atol=0.01)
    acceleration = np.hypot(*np.diff(speeds[:, :2], axis=0).T) / np.diff(times)
    assert acceleration.max() <= options.acceleration * (1.0 + 1e-6)


def test_it_goes_on_from_where_the_joints_are() -> None:
    base_pose = BasePose(-0.1, 0.3, 0.06, 0.0)
    joints = np.array([0.2, -0.05, 0.02])
    arm = ArmState(np.zeros(3), 0.01, 0.005, joints)
    start = State(SCENE.initial_state().poses, SCENE.initial_state().conditions, arm=arm)
    trajectory = planned(PATH, start, base_pose)
    assert isinstance(trajectory, JointTrajectory)
    assert np.allclose(trajectory.positions[0], joints)
    assert trajectory.gripper.openings[0] == 0.005
    assert trajectory.gripper.phases[0] is Phase.APPROACH


def test_beyond_the_joints_it_says_where_and_why() -> None:
    poses = np.array([[-0.05, 0.2, 0.0], [0.3, 0.2, 0.0], [0.3, 2.9, 0.0]])
    path = GripperPath(poses, (Phase.INSERT, Phase.SWEEP), RULES)
    found = planned(path, SCENE.initial_state(), BasePose(-0.1, 0.3, 0.06, 0.0))
    assert isinstance(found, Unreachable)
    approach = math.hypot(0.05, 0.1)
    assert found.where == pytest.approx(approach + 0.35)
    assert "y 2.900 m" in found.why
    assert found.leg == 2


def test_a_path_that_goes_nowhere_is_a_short_rest() -> None:
    arm = ArmState(np.array([-0.05, 0.2, 0.0]), 0.0)
    start = State(SCENE.initial_state().poses, SCENE.initial_state().conditions, arm=arm)
    path = GripperPath(np.array([arm.gripper, arm.gripper]), (Phase.INSERT,), RULES)
    trajectory = planned(path, start, BasePose(-0.1, 0.3, 0.06, 0.0))
    assert isinstance(trajectory, JointTrajectory)
    assert 0.0 < trajectory.duration < 0.1
    assert np.ptp(trajectory.positions, axis=0).max() == 0.0


@given(st.floats(1e-3, 10.0), st.floats(1e-3, 1.0))
def test_trapezoidal_profiles_are_quickest_within_speed_and_acceleration(
    at_full_speed: float, to_full_speed: float
) -> None:
    found = trapezoidal_profile(at_full_speed, to_full_speed)
    times = found.times(0.02)
    fraction, rate = found.fraction(times), found.rate(times)
    assert (fraction[0], rate[0]) == (0.0, 0.0)
    assert fraction[-1] == pytest.approx(1.0)
    assert rate[-1] == pytest.approx(0.0, abs=1e-9)
    assert rate.max() <= 1.0 / at_full_speed * (1.0 + 1e-9)
    assert np.diff(times).max() <= 0.02 + 1e-9
    assert found.peak / found.rising == pytest.approx(1.0 / (at_full_speed * to_full_speed))
    covered = np.concatenate([[0.0], np.cumsum(np.diff(times) * (rate[1:] + rate[:-1]) / 2.0)])  # exact: it is linear
    assert np.allclose(fraction, covered, atol=1e-9)
