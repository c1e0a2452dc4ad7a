"""What is particular to the MuJoCo backend; that it keeps to the interface is checked in tests/conformance."""

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

mujoco = pytest.importorskip("mujoco")

from phframe.arms.planar import PlanarArm, PlanarArmOptions  # noqa: E402
from phframe.backends.mujoco_ import MujocoOptions, MujocoPhysics  # noqa: E402
from phframe.core import (  # noqa: E402
    ArmState,
    Condition,
    Cylinder,
    FloatArray,
    GripperTrajectory,
    IncompatibleError,
    InputError,
    JointTrajectory,
    Phase,
    Scene,
    SceneObject,
    SimulationDivergedError,
    State,
    planar_pose,
)
from phframe.runtime.scenes import find_scene, scene_names  # noqa: E402
from phframe.testing import SPATIAL, PhysicsUnderTest  # noqa: E402
from phframe.testing.physics.paths import (  # noqa: E402
    CROWD_SWEEP,
    MIDDLE,
    SHELF,
    crowd,
    cylinder,
    drive_in,
    grasp,
    path,
    scene_of,
)
from phframe.testing.physics.stand import on_stand  # noqa: E402

pytestmark = pytest.mark.needs_mujoco

ARM = PlanarArm(PlanarArmOptions())
PUBLISHED = [name for name in scene_names() if name.startswith(("vieira", "papallas"))]
TARGET = cylinder("target", 0.5, 0.5)

TRANSITION_IN_A_NEW_PROCESS = """
import pickle, sys
from tests.backends.test_mujoco import swept
sys.stdout.buffer.write(pickle.dumps(swept()))
"""


def physics(scene: Scene, **options: Any) -> MujocoPhysics:
    return MujocoPhysics(scene, ARM, ARM.default_mount(scene.shelf), MujocoOptions(**options))


def subject(**options: Any) -> PhysicsUnderTest:
    chosen = MujocoOptions(**options)
    return PhysicsUnderTest(lambda s, a, m: MujocoPhysics(s, a, m, chosen), ARM, SPATIAL, name="mujoco")


def swept(**options: Any) -> Any:
    with on_stand(subject(**options), crowd()) as stand:
        return stand.run(stand.start, CROWD_SWEEP)


def let_be(backend: MujocoPhysics, seconds: float) -> State:
    """The world after nobody did anything for a while."""
    world = backend._current
    mujoco.mj_step(world.model.mj, world.data, round(seconds / backend.options.step))
    return backend.observe()


def test_another_process_gives_the_same_bits() -> None:
    command = [sys.executable, "-c", TRANSITION_IN_A_NEW_PROCESS]
    done = subprocess.run(command, capture_output=True, check=True, timeout=60)
    assert pickle.loads(done.stdout) == swept()


@pytest.mark.slow
@pytest.mark.parametrize("sleep", [True, False], ids=["asleep", "awake"])
def test_published_scenes_stay_at_rest(sleep: bool) -> None:
    assert len(PUBLISHED) == 31
    for name in PUBLISHED:
        scene = find_scene(name)
        backend = physics(scene, sleep=sleep)
        start = backend.restore(scene.initial_state())
        moved = start.displacement(let_be(backend, 5.0))
        assert moved.max() < 1e-3, f"{name}: {moved}"


def test_sleeping_changes_little() -> None:
    awake, asleep = swept(sleep=False), swept(sleep=True)
    assert asleep.state.conditions == awake.state.conditions
    assert asleep.state.displacement(awake.state).max() < 5e-3


@pytest.mark.parametrize(
    ("cone", "angle"), [("elliptic", 0.0), ("elliptic", 30.0), ("elliptic", 45.0), ("pyramidal", 0.0)]
)
@pytest.mark.parametrize(("friction", "speed"), [(0.15, 0.2), (0.25, 0.5), (0.4, 0.5)])
def test_what_slides_stops_where_coulomb_says(cone: str, angle: float, friction: float, speed: float) -> None:
    """In every direction; a pyramid is Coulomb's cone along its edges only."""
    backend = physics(scene_of(cylinder("o", 0.2, MIDDLE, friction=friction), TARGET), cone=cone)
    backend.restore(backend.scene.initial_state())
    let_be(backend, 0.1)
    world, turned = backend._current, math.radians(angle)
    before = backend.observe().positions[0]
    world.data.qvel[world.model.moving[0][:2]] = speed * math.cos(turned), speed * math.sin(turned)
    way = let_be(backend, 1.0).positions[0] - before
    assert np.hypot(*way) == pytest.approx(speed**2 / (2.0 * friction * 9.81), rel=0.03)
    assert math.degrees(math.atan2(way[1], way[0])) == pytest.approx(angle, abs=1.0)


def test_the_force_told_is_that_of_the_contacts() -> None:
    with on_stand(subject(), scene_of(cylinder("load", 0.2, MIDDLE, mass=3.0, friction=0.5))) as stand:
        stand.physics.restore(stand.start)
        stand.physics.execute(stand.trajectory(stand.start, drive_in(0.22, speed=0.1)), settle=None)
        world = stand.physics._current  # type: ignore[attr-defined]
        total = np.zeros(3)
        for row, contact in enumerate(world.data.contact):
            one, other = (world.model.is_arm[geom] for geom in contact.geom)
            if one != other:
                force = np.zeros(6)
                mujoco.mj_contactForce(world.model.mj, world.data, row, force)
                total += (1.0 if other else -1.0) * contact.frame.reshape(3, 3).T @ force[:3]
        count, *told = world.data.sensordata
        assert count > 0
        assert np.linalg.norm(total) > 10.0
        assert np.allclose(np.abs(told), np.abs(total), rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("angle", [10.0, 30.0, 45.0, 60.0, 80.0])
@pytest.mark.parametrize("depth", [1e-4, 1e-3])
def test_an_edge_pushes_towards_the_axis(angle: float, depth: float) -> None:
    """Contacts of a finger's edge with a cylinder; with MuJoCo's own convex collision they point along the finger."""
    turned = math.radians(angle)
    corner = np.array([0.2, MIDDLE + ARM.options.insertion_width / 2.0])
    away = np.array([math.cos(turned), math.sin(turned)])
    center = corner + (0.03 - depth) * away
    backend = physics(scene_of(cylinder("o", float(center[0]), float(center[1])), TARGET))
    arm = ArmState(np.array([0.2, MIDDLE, 0.0]), 0.0)
    backend.restore(replace(backend.scene.initial_state(), arm=arm))
    world = backend._current
    mujoco.mj_forward(world.model.mj, world.data)
    pushes = [
        contact.frame[:3] * (1.0 if world.model.is_arm[contact.geom[0]] else -1.0)
        for contact in world.data.contact
        if world.model.is_arm[contact.geom[0]] != world.model.is_arm[contact.geom[1]]
    ]
    assert pushes
    for push in pushes:
        assert math.degrees(math.atan2(push[1], push[0])) == pytest.approx(angle, abs=3.0)


@pytest.mark.parametrize(("friction", "condition"), [(0.25, Condition.UPRIGHT), (0.8, Condition.TOPPLED)])
def test_what_sticks_to_the_board_topples(friction: float, condition: Condition) -> None:
    """Pushed at a height z of 4 to 8 cm: it tips where z > r / mu, which is 8 cm or 2.5 cm."""
    item = SceneObject("tall", Cylinder(0.02, 0.14), (0.2, MIDDLE), friction=friction)
    with on_stand(subject(), scene_of(item, TARGET)) as stand:
        made = stand.run(stand.start, drive_in(0.3))
        assert made.state.conditions[0] is condition
        assert made.motion.settled
        assert stand.physics.restore(made.state.parked()).poses.tolist() == made.state.poses.tolist()


def test_what_rolls_comes_to_rest() -> None:
    lying = np.array([0.3, MIDDLE, 0.03, math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0])
    backend = physics(scene_of(cylinder("o", 0.3, MIDDLE), TARGET))
    start = backend.scene.initial_state()
    poses = np.array([lying, start.poses[1]])
    backend.restore(State(poses, (Condition.TOPPLED, Condition.UPRIGHT)))
    world = backend._current
    world.data.qvel[world.model.moving[0][1]] = 0.1
    rolled = let_be(backend, 3.0)
    assert abs(rolled.poses[0, 1] - MIDDLE) > 0.01
    assert world.speeds.max() < 1e-3


def test_the_hand_holds_by_friction_alone() -> None:
    radius = 0.03
    scene = scene_of(cylinder("other", 0.45, 0.5), cylinder("target", 0.25, MIDDLE, radius=radius))
    for friction, held in ((0.3, "target"), (0.0, None)):
        with on_stand(subject(arm_friction=friction), scene) as stand:
            made = stand.run(stand.start, grasp(ARM, 0.25))
            assert made.state.held == held


def test_nothing_is_under_what_is_held_outside() -> None:
    scene = scene_of(cylinder("other", 0.45, 0.5), cylinder("target", 0.25, MIDDLE))
    with on_stand(subject(), scene) as stand:
        out = stand.run(stand.start, grasp(ARM, 0.25)).state
        assert out.held == "target"
        assert out.arm is not None
        assert out.poses[1, 0] < -0.1
        wide = path([out.arm.gripper, out.arm.gripper], [Phase.REACH], opening=ARM.shape.max_opening)
        let_go = stand.run(out, wide).state
        assert (let_go.held, let_go.conditions[1]) == (None, Condition.SPILLED)


def test_a_gripper_trajectory_is_refused() -> None:
    backend = physics(crowd())
    gripper = GripperTrajectory(np.array([0.0, 1.0]), np.zeros((2, 3)), np.zeros(2), (Phase.INSERT,), 60.0)
    with pytest.raises(InputError, match="drives joints"):
        backend.execute(gripper, settle=None)


@pytest.mark.parametrize(
    ("end", "seconds", "message"),
    [
        ([3.0, 0.0, 0.0], 100.0, r"joint 'x' from 0.000 to 3.000; its limits are -1 and 2"),
        ([1.0, 0.0, 0.0], 0.5, "joint 'x' at 2.000; its limit is 1"),
    ],
    ids=["too far", "too fast"],
)
def test_what_is_beyond_the_joints_is_refused_before_anything_moves(
    end: list[float], seconds: float, message: str
) -> None:
    backend = physics(crowd())
    before = backend.restore(backend.scene.initial_state())
    positions = np.array([np.zeros(3), end])
    base = np.array([-0.1, SHELF.width / 2.0, 0.0])
    gripper = GripperTrajectory(np.array([0.0, seconds]), base + positions, np.zeros(2), (Phase.INSERT,), 60.0)
    speeds = np.diff(positions, axis=0) / seconds
    with pytest.raises(InputError, match=message):
        backend.execute(JointTrajectory(gripper, positions, np.vstack([speeds, speeds])), settle=None)
    assert backend.observe() == before


def test_states_of_another_arm_are_refused() -> None:
    backend = physics(crowd())
    start = backend.scene.initial_state()
    for arm, message in (
        (ArmState(np.zeros(3), 0.0, joints=np.zeros(7)), "has 7 joints, this one 3"),
        (ArmState(np.zeros(3), 0.0, joints=np.array([np.nan, 0.0, 0.0])), "not finite"),
        (ArmState(np.array([9.0, 0.0, 0.0]), 0.0), "cannot have its fingertip"),
    ):
        with pytest.raises(InputError, match=message):
            backend.restore(replace(start, arm=arm))


@pytest.mark.parametrize("speed", [np.nan, 1e4, 1e12])
def test_divergence_is_an_error_with_a_reason_and_leaves_no_log(
    speed: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    with on_stand(subject(), crowd()) as stand:
        stand.physics.restore(stand.start)
        trajectory = stand.trajectory(stand.start, drive_in(0.1))
        world = stand.physics._current  # type: ignore[attr-defined]
        world.data.qvel[world.model.moving[0][2]] = speed
        with pytest.raises(SimulationDivergedError, match="the simulation diverged"):
            stand.physics.execute(trajectory, settle=None)
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr().err == ""


def test_names_of_objects_may_be_those_of_walls_and_links() -> None:
    names = ("board", "south wall", "fingertip", "arm/x")
    objects = [cylinder(name, 0.2 + 0.1 * row, MIDDLE) for row, name in enumerate(names)]
    with on_stand(subject(), scene_of(*objects)) as stand:
        motion = stand.run(stand.start, drive_in(0.2)).motion
        assert {contact.body for contact in motion.contacts} == {"board"}
        assert motion.wall_contacts == ()


class LacksItsTip(PlanarArm):
    tip_link = "nose"


class HasNoUrdf(PlanarArm):
    def urdf(self) -> str:
        return "<robot name='r'><link name='base'/><joint name='j' type='banana'/></robot>"


@pytest.mark.parametrize(
    ("kind", "message"), [(LacksItsTip, "no joint or link nose"), (HasNoUrdf, "cannot load the URDF")]
)
def test_an_arm_that_does_not_load_is_refused(kind: type[PlanarArm], message: str) -> None:
    scene = crowd()
    with pytest.raises(IncompatibleError, match=message):
        MujocoPhysics(scene, kind(PlanarArmOptions()), ARM.default_mount(SHELF), MujocoOptions()).restore(
            scene.initial_state()
        )


def test_what_the_arm_reaches_with_its_joints_is_where_forward_says() -> None:
    backend = physics(crowd())
    rng: np.random.Generator = np.random.default_rng(3)
    for q in rng.uniform([-0.2, -0.2, -1.0], [0.5, 0.2, 1.0], (20, 3)):
        arm = ArmState(np.zeros(3), 0.0, joints=q)
        state = backend.restore(replace(backend.scene.initial_state(), arm=arm))
        assert state.arm is not None
        mount = backend.mount
        wanted: FloatArray = np.array([mount.x, mount.y, mount.yaw]) + q
        assert np.allclose(state.arm.gripper, wanted, atol=1e-9)
        assert np.allclose(planar_pose(*state.arm.gripper[:2]), planar_pose(*wanted[:2]), atol=1e-9)
