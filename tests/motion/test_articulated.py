"""The motion planner of arms that are given by a URDF: what it promises, on Baxter and on an arm of six joints."""

from __future__ import annotations

import math
import re
import sys
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

pytest.importorskip("pinocchio")
pytest.importorskip("ompl")
pytest.importorskip("toppra")

from phframe.arms.articulated import ArticulatedArm
from phframe.arms.baxter import Baxter, BaxterOptions
from phframe.core import (
    BasePose,
    Condition,
    Contacts,
    FloatArray,
    GripperPath,
    JointTrajectory,
    MotionPlanner,
    NotInstalledError,
    Phase,
    Scene,
    State,
    UnknownNameError,
    Unreachable,
)
from tests.motion.motions import (
    BEFORE,
    CROWD,
    DEEP,
    EMPTY,
    MIDDLE,
    SHELF,
    TURNED,
    baxter,
    cylinder,
    example,
    grasp,
    insertion,
    off_the_path,
    paths,
    planned,
    planner,
    seen,
    sweep,
)

pytestmark = [pytest.mark.needs_baxter, pytest.mark.needs_ompl]

ARMS = {"left": baxter, "right": lambda: baxter("right"), "example": example}
JUDGED = 0.02
"""Between the configurations that are looked at for collisions (s)."""


def check(motion: JointTrajectory | Unreachable, planner: MotionPlanner[Any], path: GripperPath, state: State) -> None:
    assert isinstance(motion, JointTrajectory), motion
    arm = planner.arm
    times = np.append(np.arange(0.0, motion.duration, 1e-3), motion.duration)
    positions, speeds = motion.sample(times)
    check_joints(motion, positions, speeds, arm)
    check_phases(motion, path)
    check_openings(motion, path, arm.shape.min_opening if state.arm is None else state.arm.commanded_opening)
    check_tip(motion, planner, path, times)


def check_joints(motion: JointTrajectory, positions: FloatArray, speeds: FloatArray, arm: Any) -> None:
    assert (np.diff(motion.times) > 0.0).all()
    limits = np.array([[joint.lower, joint.upper, joint.velocity] for joint in arm.joints]).T
    assert (positions >= limits[0] - 1e-6).all()
    assert (positions <= limits[1] + 1e-6).all()
    assert (np.abs(speeds) <= limits[2]).all()
    assert (np.abs(np.diff(positions, axis=0)) <= limits[2] * 1.01e-3).all(), "no jumps"
    assert not motion.velocities[[0, -1]].any() or np.abs(motion.velocities[[0, -1]]).max() < 1e-6


def check_phases(motion: JointTrajectory, path: GripperPath) -> None:
    """An approach, if any, and then the path's phases in its order."""
    order = list(dict.fromkeys(motion.gripper.phases))
    assert order == [Phase.APPROACH, *path.phases]


def check_openings(motion: JointTrajectory, path: GripperPath, begin: float) -> None:
    gripper = motion.gripper
    assert gripper.openings[0] == pytest.approx(begin, abs=1e-9)
    for number, phase in enumerate(path.phases):
        rule = path.rule(number)
        last = max(leg for leg, found in enumerate(gripper.phases) if found is phase) + 1
        assert gripper.openings[last] == pytest.approx(rule.opening, abs=1e-6), phase
        first = gripper.phases.index(phase)
        steps = np.diff(gripper.openings[first : last + 1]) / np.diff(gripper.times[first : last + 1])
        assert np.abs(steps).max(initial=0.0) <= rule.finger_speed * 1.02


def check_tip(motion: JointTrajectory, planner: MotionPlanner[Any], path: GripperPath, times: FloatArray) -> None:
    looks = times[:: 1 if len(times) < 2000 else 3]
    points, tilts = seen(motion, planner, looks)
    on_path = np.array([motion.gripper.phase_at(time) is not Phase.APPROACH for time in looks])
    deep = on_path & (points[:, 0] > DEEP)
    assert deep.any()
    distances, turns = off_the_path(points[deep], path)
    assert distances.max() < 2e-3
    assert np.abs(points[deep, 2] - planner.arm.shape.height).max() < 2e-3
    assert tilts[deep].max() < 1e-3
    assert turns.max() <= TURNED + 1e-3
    inside = points[:, 0] > 0.005
    assert on_path[inside].all(), "nothing of the way to the path is in the shelf"
    gripper = motion.gripper
    at_samples, _ = seen(motion, planner, gripper.times)
    assert np.abs(at_samples[:, :2] - gripper.poses[:, :2]).max() < 1e-3
    later = np.array([False, *(phase is not Phase.APPROACH for phase in gripper.phases)])
    turned = np.abs(np.remainder(at_samples[later, 3] - gripper.poses[later, 2] + math.pi, math.tau) - math.pi)
    assert turned.max() < 2e-3
    for number, phase in enumerate(path.phases):
        rows = [leg for leg, found in enumerate(gripper.phases) if found is phase]
        steps = np.hypot(*np.diff(at_samples[[*rows, rows[-1] + 1], :2], axis=0).T)
        spans = np.diff(gripper.times[[*rows, rows[-1] + 1]])
        assert (steps / spans).max() <= path.rule(number).speed * 1.02


@pytest.mark.parametrize("kind", ["straight", "sweep", "angled", "grasp"])
@pytest.mark.parametrize("name", ARMS)
def test_the_gripper_follows_the_path(name: str, kind: str) -> None:
    arm = ARMS[name]()
    path, ours = paths(arm)[kind], planner(arm)
    start = EMPTY.initial_state()
    motion = planned(ours, path)
    check(motion, ours, path, start)
    assert isinstance(motion, JointTrajectory)
    assert motion.positions[0].tobytes() == arm.home.tobytes()
    check_nothing_is_hit(motion, ours, path, start)


@settings(max_examples=8, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_whatever_is_planned_keeps_the_promises(data: st.DataObject) -> None:
    """Anywhere that baxter_mount.md says can be followed, and where not, a reason."""
    arm = ARMS[data.draw(st.sampled_from(sorted(ARMS)))]()
    x, y = data.draw(st.floats(0.1, 0.5)), data.draw(st.floats(MIDDLE - 0.2, MIDDLE + 0.2))
    end = data.draw(st.floats(MIDDLE - 0.2, MIDDLE + 0.2))
    path = data.draw(st.sampled_from([insertion(arm, x, y), sweep(arm, x, y, end), grasp(arm, x, y)]))
    ours, start = planner(arm), EMPTY.initial_state()
    motion = planned(ours, path)
    assume(isinstance(motion, JointTrajectory))
    check(motion, ours, path, start)


def check_nothing_is_hit(motion: JointTrajectory, planner: MotionPlanner[Any], path: GripperPath, state: State) -> None:
    """By MuJoCo's collision, which shares nothing with the planner's."""
    judge = judge_of(planner, state)
    scene = planner.scene
    for time in np.append(np.arange(0.0, motion.duration, JUDGED), motion.duration):
        phase = motion.gripper.phase_at(float(time))
        rule = path.rule(path.phases.index(phase)) if phase in path.phases else None
        allowed = {Contacts.OBJECTS: set(scene.ids), Contacts.MANIPULAND: {path.manipuland or ""}}
        may = allowed.get(rule.contacts if rule else Contacts.NONE, set())
        found = judge.touching(motion.sample([time])[0][0], motion.gripper.at(float(time))[1])
        assert {pair for pair in found if not may & set(pair)} == set(), (time, phase)


def judge_of(planner: MotionPlanner[Any], state: State) -> Any:
    pytest.importorskip("mujoco")
    from tests.motion.judge import Judge

    judge = Judge(cast(ArticulatedArm[Any], planner.arm), planner.scene, planner.base_pose)
    judge.place(state)
    return judge


@pytest.mark.needs_mujoco
@pytest.mark.parametrize("name", ARMS)
def test_in_a_crowd_nothing_forbidden_is_touched(name: str) -> None:
    arm = ARMS[name]()
    ours, path, start = planner(arm, CROWD), grasp(arm, 0.4, MIDDLE), CROWD.initial_state()
    motion = planned(ours, path)
    check(motion, ours, path, start)
    assert isinstance(motion, JointTrajectory)
    check_nothing_is_hit(motion, ours, path, start)


def test_what_has_spilled_is_in_nobodys_way() -> None:
    arm = baxter()
    scene = Scene("s", SHELF, (cylinder("blocking", 0.2, MIDDLE), cylinder("target", 0.4, MIDDLE)), "target")
    path, start = grasp(arm, 0.4, MIDDLE), scene.initial_state()
    found = planned(planner(arm, scene), path)
    assert isinstance(found, Unreachable)
    assert "blocking" in found.bodies
    assert "blocking" in found.why
    spilled = State(start.poses, (Condition.SPILLED, Condition.UPRIGHT))
    assert isinstance(planned(planner(arm, scene), path, spilled), JointTrajectory)


@pytest.mark.parametrize(
    ("x", "y", "why"),
    [(0.45, 0.02, "south wall"), (0.45, SHELF.width - 0.02, "north wall"), (0.9, MIDDLE, "back wall|out of reach")],
)
def test_beyond_what_the_arm_can_do_it_says_where_and_why(x: float, y: float, why: str) -> None:
    """The fingers are 0.053 m to either side, and what lies behind the shelf cannot be reached."""
    arm = baxter()
    found = planned(planner(arm), insertion(arm, x, y))
    assert isinstance(found, Unreachable)
    assert re.search(why, found.why), found
    assert re.search(r"at x -?\d\.\d{3} m, y \d\.\d{3} m, yaw -?\d+ degrees$", found.why)
    assert 0.0 < found.where < x - BEFORE
    assert found.leg == 0
    assert all(body in found.why for body in found.bodies)
    assert bool(found.bodies) == ("meets" in found.why)


def test_where_the_wrist_would_meet_a_wall_the_gripper_is_turned() -> None:
    """At yaw 0 with the tip within 0.066 m of a wall beyond 0.22 m, the tube before the wrist is in the wall."""
    arm = baxter()
    ours, path = planner(arm), insertion(arm, 0.4, SHELF.width - 0.0625)
    motion = planned(ours, path)
    check(motion, ours, path, EMPTY.initial_state())
    assert isinstance(motion, JointTrajectory)
    inside = motion.gripper.poses[motion.gripper.poses[:, 0] > 0.3, 2]
    assert inside.min() > 0.05


@pytest.mark.parametrize("away", [(-0.4, 0.0, 0.0), (0.0, 0.0, 0.6)], ids=["back", "up"])
def test_from_a_mount_too_far_away_nothing_is_in_reach(away: tuple[float, float, float]) -> None:
    arm = baxter()
    usual = arm.default_base_pose(SHELF)
    base_pose = BasePose(usual.x + away[0], usual.y + away[1], usual.z + away[2], usual.yaw)
    found = planned(planner(arm, EMPTY, base_pose), insertion(arm, 0.4, MIDDLE))
    assert isinstance(found, Unreachable)
    assert "reach" in found.why or "meets" in found.why
    assert "\n" not in found.why


def test_a_planner_that_does_not_exist_is_answered_with_those_there_are() -> None:
    arm = Baxter(BaxterOptions(motion_planner="RTConnect"))
    with pytest.raises(UnknownNameError, match=r"'RTConnect'. Did you mean 'RRTConnect'\?.*BiEST"):
        planner(arm)


def test_without_ompl_there_is_an_install_line_before_anything_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ompl", None)
    monkeypatch.delitem(sys.modules, "ompl.base", raising=False)
    with pytest.raises(NotInstalledError, match=r"phframe\[ompl\]") as caught:
        planner(baxter())
    assert "\n" not in str(caught.value)


def test_without_toppra_there_is_one_too(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "toppra"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "toppra", None)
    for name in ("articulated", "time_parametrisation", "toppra_"):
        monkeypatch.delitem(sys.modules, f"phframe.motion.{name}", raising=False)
    with pytest.raises(NotInstalledError, match=r"Baxter needs toppra.*phframe\[baxter\]") as caught:
        planner(baxter())
    assert "\n" not in str(caught.value)
