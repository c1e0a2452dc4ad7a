"""The motion planner of arms that are given by a URDF: how it goes on from where the arm is, after a stall for one."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pinocchio")
pytest.importorskip("ompl")
pytest.importorskip("toppra")

from phframe.core import (
    ArmError,
    ArmState,
    Contacts,
    FloatArray,
    GripperPath,
    JointTrajectory,
    MotionPlanner,
    Phase,
    PhaseRule,
    Unreachable,
    compose,
    inverse,
    planar_pose,
)
from tests.motion.motions import (
    CROWD,
    DEEP,
    EMPTY,
    MIDDLE,
    arm_state,
    baxter,
    example,
    halfway,
    insertion,
    planned,
    planner,
    seen,
    seen_at,
)

pytestmark = [pytest.mark.needs_baxter, pytest.mark.needs_ompl]

ARMS = {"left": baxter, "right": lambda: baxter("right"), "example": example}


def retreat(arm: Any, begin: FloatArray) -> GripperPath:
    """Straight back along the gripper, as a world does after a stall."""
    ahead = np.array([math.cos(begin[2]), math.sin(begin[2]), 0.0])
    out = begin - ahead * (begin[0] + 0.1) / ahead[0]
    rules = {Phase.RETREAT: PhaseRule(0.3, arm.shape.min_opening, Contacts.OBJECTS)}
    return GripperPath(np.array([begin, out]), (Phase.RETREAT,), rules)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("x", [0.15, 0.4])
def test_after_a_stall_it_draws_back_in_the_same_configuration(name: str, x: float) -> None:
    arm = ARMS[name]()
    ours = planner(arm)
    q = halfway(ours, insertion(arm, 0.45, MIDDLE + 0.08), x)
    q += np.random.default_rng(0).uniform(-1.0, 1.0, len(q)) * 4e-3  # pressed off the path
    here = arm_state(ours, q)
    state = replace(EMPTY.initial_state(), arm=here)
    motion = planned(ours, retreat(arm, here.gripper), state)
    assert isinstance(motion, JointTrajectory), motion
    assert motion.positions[0].tobytes() == q.tobytes()
    assert set(motion.gripper.phases) == {Phase.RETREAT}, "it begins where the arm is"
    assert np.abs(np.diff(motion.positions, axis=0)).max() < 0.2
    points, _ = seen(motion, ours, motion.times)
    assert np.allclose(points[:, [0, 1, 3]], motion.gripper.poses, atol=1e-3)
    assert points[-1, 0] < -0.01
    sideways = np.abs(points[points[:, 0] > DEEP, 1] - here.gripper[1]).max()
    assert sideways < 5e-3 + abs(math.tan(here.gripper[2])) * 0.5


def test_what_touches_a_wall_where_it_stands_may_draw_back() -> None:
    """The world ends a motion at the first touch of a wall, and what touches it is nearer than any margin."""
    arm = baxter()
    y = 0.0545  # the fingers are 0.053 m to either side
    scene = EMPTY
    ours = planner(arm, scene)
    q = halfway(ours, insertion(arm, 0.15, y + 0.03), 0.12)
    beside = np.append(seen_at(ours, q)[:2], 0.0)
    inward = planned(ours, GripperPath(np.array([beside, beside - [0.0, 0.0284, 0.0]]), (Phase.SWEEP,), {
        Phase.SWEEP: PhaseRule(0.2, arm.shape.min_opening, Contacts.OBJECTS)}), replace(
            scene.initial_state(), arm=arm_state(ours, q)))  # fmt: skip
    assert isinstance(inward, JointTrajectory), inward
    q = close_to_the_wall(ours, np.array(inward.positions[-1]))
    here = arm_state(ours, q)
    motion = planned(ours, retreat(arm, here.gripper), replace(scene.initial_state(), arm=here))
    assert isinstance(motion, JointTrajectory), motion
    assert motion.gripper.poses[-1, 0] < -0.01


def close_to_the_wall(planner: MotionPlanner[Any], q: FloatArray) -> FloatArray:
    """Joint values with the gripper moved to 1 mm from where it would touch the south wall."""
    pose = seen_at(planner, q)
    base = inverse(planner.base_pose.pose)
    half = planner.arm.shape.insertion_width / 2.0
    target = compose(base, planar_pose(pose[0], half + 1e-3, planner.arm.shape.height, 0.0))
    found = planner.arm.inverse(target, q)
    assert found is not None
    return np.array(found)


def test_from_inside_the_shelf_another_path_is_begun_on_a_free_way() -> None:
    arm = baxter()
    ours = planner(arm, CROWD)
    q = halfway(ours, insertion(arm, 0.3, MIDDLE), 0.2)
    state = replace(CROWD.initial_state(), arm=arm_state(ours, q))
    path = insertion(arm, 0.3, MIDDLE + 0.1)
    motion = planned(ours, path, state)
    assert isinstance(motion, JointTrajectory), motion
    assert motion.positions[0].tobytes() == q.tobytes()
    assert motion.gripper.phases[0] is Phase.APPROACH
    assert motion.gripper.poses[-1, 0] < -0.01


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_joints_that_are_no_numbers_are_refused(value: float) -> None:
    arm = baxter()
    ours = planner(arm)
    q = np.array(arm.home)
    q[3] = value
    state = replace(EMPTY.initial_state(), arm=ArmState(np.array([-0.03, 0.3, 0.0]), 0.035, joints=q))
    with pytest.raises(ArmError, match="finite") as caught:
        planned(ours, insertion(arm, 0.3, MIDDLE), state)
    assert "\n" not in str(caught.value)


def test_a_gripper_that_cannot_be_where_it_is_said_to_be() -> None:
    arm = baxter()
    state = replace(EMPTY.initial_state(), arm=ArmState(np.array([4.0, 0.3, 0.0]), 0.035))
    found = planned(planner(arm), insertion(arm, 0.3, MIDDLE), state)
    assert isinstance(found, Unreachable)
    assert "cannot have the gripper where it is said to be" in found.why


def test_joints_a_little_beyond_their_limits_come_back() -> None:
    arm = baxter()
    q = np.array(arm.home)
    q[0] = arm.joints[0].upper + 1e-4
    ours = planner(arm)
    motion = planned(ours, insertion(arm, 0.3, MIDDLE), replace(EMPTY.initial_state(), arm=arm_state(ours, q)))
    assert isinstance(motion, JointTrajectory), motion
    assert motion.positions[0].tobytes() == q.tobytes()
    assert motion.positions[-1, 0] <= arm.joints[0].upper


def test_a_path_on_which_only_the_fingers_move() -> None:
    arm = baxter()
    ours = planner(arm)
    q = halfway(ours, insertion(arm, 0.3, MIDDLE), 0.25)
    here = arm_state(ours, q)
    rules = {Phase.GRASP: PhaseRule(0.1, arm.shape.max_opening, Contacts.OBJECTS)}
    path = GripperPath(np.array([here.gripper, here.gripper]), (Phase.GRASP,), rules)
    motion = planned(ours, path, replace(EMPTY.initial_state(), arm=here))
    assert isinstance(motion, JointTrajectory), motion
    assert motion.gripper.openings[-1] == pytest.approx(arm.shape.max_opening)
    assert np.abs(np.ptp(motion.positions, axis=0)).max() < 0.05
    nominal = (arm.shape.max_opening - arm.shape.min_opening) / 0.1
    assert nominal <= motion.duration < 3.0 * nominal
