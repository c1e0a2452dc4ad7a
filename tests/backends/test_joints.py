"""What the engines in space have in common beyond the interface, which is checked in tests/conformance."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import (
    ArmState,
    Condition,
    Cylinder,
    GripperTrajectory,
    IncompatibleError,
    InputError,
    JointTrajectory,
    Phase,
    SceneObject,
    SimulationDivergedError,
    State,
)
from phframe.runtime.scenes import find_scene
from phframe.testing.physics.paths import MIDDLE, SHELF, crowd, cylinder, drive_in, grasp, path, scene_of
from phframe.testing.physics.stand import on_stand
from tests.backends.engines import PUBLISHED, TARGET, each_engine, let_be, physics, set_moving, subject, swept

TRANSITION_IN_A_NEW_PROCESS = """
import pickle, sys
from tests.backends.engines import swept
sys.stdout.buffer.write(pickle.dumps(swept({!r})))
"""


@each_engine
def test_another_process_gives_the_same_bits(engine: str) -> None:
    command = [sys.executable, "-c", TRANSITION_IN_A_NEW_PROCESS.format(engine)]
    done = subprocess.run(command, capture_output=True, check=True, timeout=60)
    assert pickle.loads(done.stdout) == swept(engine)


@pytest.mark.slow
@each_engine
@pytest.mark.parametrize("sleep", [True, False], ids=["asleep", "awake"])
def test_published_scenes_stay_at_rest(engine: str, sleep: bool) -> None:
    assert len(PUBLISHED) == 31
    for name in PUBLISHED:
        _expect_rest(engine, name, sleep)


@each_engine
@pytest.mark.parametrize("name", ["vieira/basic", "papallas/s08"])
def test_a_scene_stays_at_rest(engine: str, name: str) -> None:
    _expect_rest(engine, name, False)


def _expect_rest(engine: str, name: str, sleep: bool) -> None:
    scene = find_scene(name)
    backend = physics(engine, scene, sleep=sleep)
    start = backend.restore(scene.initial_state())
    moved = start.displacement(let_be(backend, 5.0))
    backend.close()
    assert moved.max() < 1e-3, f"{name}: {moved}"


@each_engine
def test_sleeping_changes_little(engine: str) -> None:
    awake, asleep = swept(engine, sleep=False), swept(engine, sleep=True)
    assert asleep.state.conditions == awake.state.conditions
    assert asleep.state.displacement(awake.state).max() < 5e-3


@each_engine
@pytest.mark.parametrize(("friction", "condition"), [(0.25, Condition.UPRIGHT), (0.8, Condition.TOPPLED)])
def test_what_sticks_to_the_board_topples(engine: str, friction: float, condition: Condition) -> None:
    """Pushed at a height z of 4 to 8 cm: it tips where z > r / mu, which is 8 cm or 2.5 cm."""
    item = SceneObject("tall", Cylinder(0.02, 0.14), (0.2, MIDDLE), friction=friction)
    with on_stand(subject(engine), scene_of(item, TARGET)) as stand:
        made = stand.run(stand.start, drive_in(0.3))
        assert made.state.conditions[0] is condition
        assert made.motion.settled
        again = stand.physics.restore(made.state.parked())
        np.testing.assert_allclose(again.poses, made.state.poses, rtol=0.0, atol=1e-12)


@each_engine
def test_what_rolls_comes_to_rest(engine: str) -> None:
    object_poses = np.array([0.3, MIDDLE, 0.03, math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0])
    ways = []
    for rolling in (0.0005, 0.0):
        backend = physics(engine, scene_of(cylinder("o", 0.3, MIDDLE), TARGET), rolling_friction=rolling)
        poses = np.array([object_poses, backend.scene.initial_state().poses[1]])
        backend.restore(State(poses, (Condition.TOPPLED, Condition.UPRIGHT)))
        set_moving(backend, 0, (0.0, 0.1, 0.0))
        ways.append(abs(let_be(backend, 2.0).poses[0, 1] - MIDDLE))
        assert rolling == 0.0 or backend.world.speeds.max() < 1e-3
    assert 0.01 < ways[0] < 0.9 * ways[1]


@each_engine
def test_the_hand_holds_by_friction_alone(engine: str) -> None:
    radius = 0.03
    scene = scene_of(cylinder("other", 0.45, 0.5), cylinder("target", 0.25, MIDDLE, radius=radius))
    for friction, held in ((0.3, "target"), (0.0, None)):
        with on_stand(subject(engine, arm_friction=friction), scene) as stand:
            made = stand.run(stand.start, grasp(stand.arm, 0.25))
            assert made.state.held == held


@each_engine
def test_nothing_is_under_what_is_held_outside(engine: str) -> None:
    scene = scene_of(cylinder("other", 0.45, 0.5), cylinder("target", 0.25, MIDDLE))
    with on_stand(subject(engine), scene) as stand:
        out = stand.run(stand.start, grasp(stand.arm, 0.25)).state
        assert out.held == "target"
        assert out.arm is not None
        assert out.poses[1, 0] < -0.1
        wide = path([out.arm.gripper, out.arm.gripper], [Phase.REACH], opening=stand.arm.shape.max_opening)
        let_go = stand.run(out, wide).state
        assert (let_go.held, let_go.conditions[1]) == (None, Condition.SPILLED)


@each_engine
def test_a_gripper_trajectory_is_refused(engine: str) -> None:
    backend = physics(engine, crowd())
    gripper = GripperTrajectory(np.array([0.0, 1.0]), np.zeros((2, 3)), np.zeros(2), (Phase.INSERT,), 60.0)
    with pytest.raises(InputError, match=f"the {engine} backend drives joints"):
        backend.execute(gripper, settle=None)


@each_engine
@pytest.mark.parametrize(
    ("end", "seconds", "message"),
    [
        ([3.0, 0.0, 0.0], 100.0, r"joint 'x' from 0.000 to 3.000; its limits are -1 and 2"),
        ([1.0, 0.0, 0.0], 0.5, "joint 'x' at 2.000; its limit is 1"),
    ],
    ids=["too far", "too fast"],
)
def test_what_is_beyond_the_joints_is_refused_before_anything_moves(
    engine: str, end: list[float], seconds: float, message: str
) -> None:
    backend = physics(engine, crowd())
    before = backend.restore(backend.scene.initial_state())
    positions = np.array([np.zeros(3), end])
    base = np.array([-0.1, SHELF.width / 2.0, 0.0])
    gripper = GripperTrajectory(np.array([0.0, seconds]), base + positions, np.zeros(2), (Phase.INSERT,), 60.0)
    speeds = np.diff(positions, axis=0) / seconds
    with pytest.raises(InputError, match=message):
        backend.execute(JointTrajectory(gripper, positions, np.vstack([speeds, speeds])), settle=None)
    assert backend.observe() == before


@each_engine
def test_states_of_another_arm_are_refused(engine: str) -> None:
    backend = physics(engine, crowd())
    start = backend.scene.initial_state()
    for arm, message in (
        (ArmState(np.zeros(3), 0.0, joints=np.zeros(7)), "has 7 joints, this one 3"),
        (ArmState(np.zeros(3), 0.0, joints=np.array([np.nan, 0.0, 0.0])), "not finite"),
        (ArmState(np.array([9.0, 0.0, 0.0]), 0.0), "cannot have its fingertip"),
    ):
        with pytest.raises(InputError, match=message):
            backend.restore(replace(start, arm=arm))


@each_engine
@pytest.mark.parametrize("speed", [np.nan, 1e4, 1e12])
def test_divergence_is_an_error_with_a_reason_and_leaves_no_log(
    engine: str, speed: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    with on_stand(subject(engine), crowd()) as stand:
        stand.physics.restore(stand.start)
        trajectory = stand.trajectory(stand.start, drive_in(0.1))
        set_moving(stand.physics, 0, (0.0, 0.0, speed))
        with pytest.raises(SimulationDivergedError, match="the simulation diverged"):
            stand.physics.execute(trajectory, settle=None)
        assert stand.physics.restore(stand.start).poses.tolist() == stand.start.poses.tolist(), "it can go on"
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


@each_engine
def test_what_diverges_on_the_way_is_found(engine: str) -> None:
    with on_stand(subject(engine, sleep=False), crowd()) as stand:
        stand.physics.restore(stand.start)
        inside: Any = stand.physics.world.engine  # type: ignore[attr-defined]
        trajectory = stand.trajectory(stand.start, drive_in(0.1))
        advance, ticks = inside.advance, []

        def then_wild() -> Any:
            ticks.append(0)
            if len(ticks) == 59:
                set_moving(stand.physics, 0, (0.0, -30.0, 0.0))
            return advance()

        inside.advance = then_wild
        with pytest.raises(SimulationDivergedError, match="'a' moves at"):
            stand.physics.execute(trajectory, settle=None)
        assert len(ticks) < 70


@each_engine
def test_names_of_objects_may_be_those_of_walls_and_links(engine: str) -> None:
    names = ("board", "south wall", "fingertip", "arm/x")
    objects = [cylinder(name, 0.2 + 0.1 * row, MIDDLE) for row, name in enumerate(names)]
    with on_stand(subject(engine), scene_of(*objects)) as stand:
        motion = stand.run(stand.start, drive_in(0.2)).motion
        assert {contact.body for contact in motion.contacts} == {"board"}
        assert motion.wall_contacts == ()


class LacksItsTip(PlanarArm):
    tip_link = "nose"


class HasNoUrdf(PlanarArm):
    def urdf(self) -> str:
        return "<robot name='r'><link name='base'/><joint name='j' type='banana'/></robot>"


class HasNothing(PlanarArm):
    def urdf(self) -> str:
        return "<robot"


@each_engine
@pytest.mark.parametrize("kind", [LacksItsTip, HasNoUrdf, HasNothing])
def test_an_arm_that_does_not_load_is_refused(
    engine: str, kind: type[PlanarArm], capfd: pytest.CaptureFixture[str]
) -> None:
    scene = crowd()
    with pytest.raises(IncompatibleError, match=r"no joint or link|cannot load the URDF") as found:
        physics(engine, scene, kind(PlanarArmOptions())).restore(scene.initial_state())
    assert "\n" not in str(found.value)
    assert capfd.readouterr() == ("", "")


@each_engine
def test_what_the_arm_reaches_with_its_joints_is_where_forward_says(engine: str) -> None:
    backend = physics(engine, crowd())
    rng = np.random.default_rng(3)
    for q in rng.uniform([-0.2, -0.2, -1.0], [0.5, 0.2, 1.0], (20, 3)):
        arm = ArmState(np.zeros(3), 0.0, joints=q)
        state = backend.restore(replace(backend.scene.initial_state(), arm=arm))
        assert state.arm is not None
        base_pose = backend.base_pose
        assert np.allclose(state.arm.gripper, np.array([base_pose.x, base_pose.y, base_pose.yaw]) + q, atol=1e-6)
