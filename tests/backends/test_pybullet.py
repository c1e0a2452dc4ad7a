"""What is particular to the PyBullet backend; what it shares is in test_joints.py, the interface in tests/conformance."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import ArmState, Cylinder, FloatArray, Phase, SceneObject, Shelf, State, compose, yaw_of
from phframe.testing.physics.paths import MIDDLE, SHELF, crowd, cylinder, drive_in, path, scene_of
from phframe.testing.physics.stand import on_stand
from tests.backends.engines import ARM, TARGET, let_be, physics, set_moving, slide, subject

pytest.importorskip("pybullet")
pytestmark = pytest.mark.needs_pybullet


def world_of(
    *items: SceneObject, shelf: Shelf = SHELF, arm: Any = ARM, state: State | None = None, **options: Any
) -> Any:
    """The engine's world of a scene, restored to a state."""
    backend = physics("pybullet", scene_of(*items, shelf=shelf), arm, **options)
    backend.restore(state or backend.scene.initial_state())
    return backend.world


def drive(world: Any, joints: FloatArray, seconds: float, opening: float = 0.0) -> FloatArray:
    """Tell the joints at once to be elsewhere, for so long; what the arm feels in the end, and its speeds all along."""
    told = np.array(joints, dtype=float)[None]
    control = world.engine.controls(told, np.zeros_like(told), world.finger_values([opening]))[0]
    speeds = []
    for _ in range(round(seconds / world.engine.period)):
        world.engine.command(control)
        world.engine.advance()
        speeds.append(np.abs(world.engine.memory()[-5:]))
    return np.asarray(np.max(speeds, axis=0))


@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0])
@pytest.mark.parametrize(("friction", "speed"), [(0.15, 0.2), (0.25, 0.5), (0.4, 0.5)])
def test_what_slides_stops_where_coulomb_says(angle: float, friction: float, speed: float) -> None:
    backend = physics("pybullet", scene_of(cylinder("o", 0.2, MIDDLE, friction=friction), TARGET), sleep=False)
    way, direction = slide(backend, speed, angle)
    assert way == pytest.approx(speed**2 / (2.0 * friction * 9.81), rel=0.03)
    assert direction == pytest.approx(angle, abs=2.0)


@pytest.mark.parametrize("between", [0.0, 0.2, 0.9])
def test_every_pair_has_its_own_friction(between: float) -> None:
    """Bullet multiplies the coefficients of two bodies: what one has with the board must not depend on the others."""
    frictions = (0.15, 0.25, 0.4)
    items = [cylinder(f"o{row}", 0.1, 0.1 + 0.2 * row, friction=mu) for row, mu in enumerate(frictions)]
    backend = physics("pybullet", scene_of(*items), object_friction=between)
    before = backend.restore(backend.scene.initial_state()).positions
    for row in range(3):
        set_moving(backend, row, (0.5, 0.0, 0.0))
    ways = let_be(backend, 1.0).positions[:, 0] - before[:, 0]
    assert ways == pytest.approx([0.25 / (2.0 * mu * 9.81) for mu in frictions], rel=0.05)


@pytest.mark.parametrize("between", [0.0, 0.3])
def test_objects_rub_against_one_another_as_told(between: float) -> None:
    """One on top of another: it is carried along as far as the friction between them goes."""
    low = SceneObject("low", Cylinder(0.05, 0.05), (0.2, MIDDLE), mass=2.0, friction=0.01)
    high = SceneObject("high", Cylinder(0.03, 0.04), (0.45, MIDDLE), mass=0.1)
    backend = physics("pybullet", scene_of(low, high), object_friction=between, sleep=False)
    poses = backend.scene.initial_state().poses.copy()
    poses[1, :3] = 0.2, MIDDLE, 0.07
    backend.restore(State(poses, backend.scene.initial_state().conditions))
    let_be(backend, 0.1)
    set_moving(backend, 0, (0.3, 0.0, 0.0))
    slipping = 0.02
    let_be(backend, slipping)
    speed = float(backend.world.engine.objects().velocities[1, 0])
    assert speed == pytest.approx(between * 9.81 * slipping, abs=0.01)


@pytest.mark.parametrize("effort", [20.0, 45.0])
def test_no_joint_gives_more_than_its_effort(effort: float) -> None:
    """Told to be in a wall, the arm presses with what it may give, and that is the force that is told."""
    world = world_of(cylinder("o", 0.5, 0.1), TARGET)
    world.engine.cap(np.array([200.0, effort, 100.0]))
    drive(world, np.array([0.3, -0.4, 0.0]), 4.0)
    *_, touching, force = world.engine.advance()
    assert touching
    assert {pair[:3] for pair, _ in world.engine.contacts()} == {("link", "south wall", True)}
    assert world.engine.arm().efforts[1] == pytest.approx(effort, rel=1e-3)
    assert force == pytest.approx(effort, rel=0.1)


def test_no_joint_is_faster_than_it_is_made_for() -> None:
    world = world_of(cylinder("o", 0.5, 0.1), TARGET)
    fastest = drive(world, np.array([0.3, 0.1, -1.0]), 0.5, opening=0.08)
    limits = [joint.velocity for joint in (*ARM.joints, *ARM.fingers.joints)]
    assert (fastest <= np.array(limits) * 1.05).all()
    assert fastest[0] == pytest.approx(1.0, rel=0.05), "it was told to hurry"


def test_fingers_are_coupled() -> None:
    """Something pressed by one finger alone keeps the other back; a wall stops both."""
    world = world_of(cylinder("o", 0.2, 0.065, radius=0.03, mass=5.0, friction=1.0), TARGET)
    drive(world, np.array([0.32, -0.16, 0.0]), 2.0)
    apart = []
    for _ in range(100):
        drive(world, np.array([0.32, -0.16, 0.0]), 0.01, opening=0.08)
        apart.append(float(np.ptp(world.engine.arm().fingers)))
    assert world.engine.arm().fingers.max() > 0.005, "they open"
    assert max(apart) < 1e-3


class Idle(PlanarArm):
    """With two more joints, of which one cannot be 0, and one that follows."""

    def urdf(self) -> str:
        robot = ET.fromstring(super().urdf())
        for name, lower, upper, follows in (("head", -1.0, 1.0, None), ("lid", 0.2, 0.5, None), ("jaw", -1, 1, "head")):
            link = ET.SubElement(robot, "link", name=f"{name} link")
            inertial = ET.SubElement(link, "inertial")
            ET.SubElement(inertial, "origin", xyz="0.1 0 0")
            ET.SubElement(inertial, "mass", value="2")
            ET.SubElement(inertial, "inertia", ixx="0.01", ixy="0", ixz="0", iyy="0.01", iyz="0", izz="0.01")
            joint = ET.SubElement(robot, "joint", name=name, type="revolute")
            ET.SubElement(joint, "parent", link="base")
            ET.SubElement(joint, "child", link=f"{name} link")
            ET.SubElement(joint, "axis", xyz="0 1 0")
            ET.SubElement(joint, "limit", lower=str(lower), upper=str(upper), effort="10", velocity="1")
            if follows:
                ET.SubElement(joint, "mimic", joint=follows, multiplier="-1", offset="0.1")
        return ET.tostring(robot, encoding="unicode")


def test_joints_that_are_none_of_the_arm_stay_where_they_are() -> None:
    world = world_of(cylinder("o", 0.5, 0.1), TARGET, arm=Idle(PlanarArmOptions()))
    values = []
    for _ in range(2):
        drive(world, np.array([0.05, 0.05, 0.1]), 1.0)
        values.append(_values_by_name(world))
    assert values[0]["head"] == pytest.approx(0.0, abs=1e-3)
    assert values[0]["lid"] == pytest.approx(0.2, abs=1e-3)
    assert values[0]["jaw"] == pytest.approx(0.1, abs=2e-3), "it follows the head"
    assert values[1] == pytest.approx(values[0], abs=1e-4)


def _values_by_name(world: Any) -> dict[str, float]:
    from phframe.backends.pybullet_.output_capture import bullet

    body, client = world.engine.loaded.body, {"physicsClientId": world.engine.client}
    names = (bullet.getJointInfo(body, joint, **client)[1].decode() for joint in world.engine.loaded.movable)
    values = (bullet.getJointState(body, joint, **client)[0] for joint in world.engine.loaded.movable)
    return dict(zip(names, values, strict=True))


@pytest.mark.parametrize("angle", [10.0, 30.0, 45.0, 60.0, 80.0])
def test_an_edge_pushes_towards_the_axis(angle: float) -> None:
    turned, depth = math.radians(angle), 1e-3
    corner = np.array([0.2, MIDDLE + ARM.options.insertion_width / 2.0])
    center = corner + (0.03 - depth) * np.array([math.cos(turned), math.sin(turned)])
    scene = scene_of(cylinder("o", float(center[0]), float(center[1])), TARGET)
    state = replace(scene.initial_state(), arm=ArmState(np.array([0.2, MIDDLE, 0.0]), 0.0))
    world = world_of(*scene.objects, state=state)
    world.engine.advance()
    pushes = [push for pair, push in world.engine.contacts() if pair.finger and pair.row is not None]
    assert pushes
    for push in pushes:
        assert math.degrees(math.atan2(push[1], push[0])) == pytest.approx(angle, abs=3.0)


def test_an_even_push_takes_what_friction_does() -> None:
    with on_stand(subject("pybullet"), scene_of(cylinder("load", 0.2, MIDDLE, mass=3.0, friction=0.5))) as stand:
        stand.physics.restore(stand.start)
        world: Any = stand.physics.world  # type: ignore[attr-defined]
        advance, forces = world.engine.advance, []

        def noting() -> Any:
            forces.append((made := advance())[3])
            return made

        world.engine.advance = noting
        stand.physics.execute(stand.trajectory(stand.start, drive_in(0.3, speed=0.05)), settle=None)
    assert np.median(forces[-200:]) == pytest.approx(0.5 * 3.0 * 9.81, rel=0.05)


def test_what_sleeps_wakes_at_a_touch() -> None:
    with on_stand(subject("pybullet"), scene_of(cylinder("o", 0.2, MIDDLE), TARGET)) as stand:
        stand.physics.restore(stand.start)
        let_be(stand.physics, 3.0)
        stand.physics.execute(stand.trajectory(stand.start, drive_in(0.25)), settle=None)
        assert stand.physics.observe().poses[0, 0] > 0.27


def test_restoring_forgets_what_was_held_and_what_had_spilled() -> None:
    with on_stand(subject("pybullet"), crowd()) as stand:
        wanted = stand.run(stand.start, drive_in(0.3))
        poses, conditions = stand.start.poses.copy(), stand.start.conditions
        poses[0, 0] = -0.02
        stand.run(State(poses, conditions), path([[-0.05, 0.1, 0.0], [0.1, 0.1, 0.0]], [Phase.INSERT]))
        assert stand.physics.observe().conditions[0] != conditions[0], "it has spilled"
        assert stand.run(stand.start, drive_in(0.3)) == wanted


def test_two_backends_do_not_meet() -> None:
    one, two = (physics("pybullet", crowd()) for _ in range(2))
    start = one.restore(one.scene.initial_state())
    two.restore(two.scene.initial_state())
    two.close()
    assert one.observe() == start
    one.close()
    one.close()
    assert one.restore(start) == start, "it can be used again"


SPEAKS = """
import os, ctypes
from phframe.backends.pybullet_.output_capture import caught_output
print("before")
with caught_output() as said:
    print("inside")
    ctypes.CDLL(None).puts(b"from C")
    os.write(2, b"an error\\n")
print("after", said)
"""


def test_what_c_code_says_is_caught_and_nothing_else() -> None:
    done = subprocess.run([sys.executable, "-c", SPEAKS], capture_output=True, check=True, text=True, timeout=60)
    first, last = done.stdout.splitlines()
    assert first == "before"
    assert last.startswith("after")
    assert all(word in last for word in ("inside", "from C", "an error"))
    assert done.stderr == ""


def test_json_on_standard_output_is_json_alone(tmp_path: Path) -> None:
    program = "from phframe.cli.main import main; main()"
    arguments = ["solve", "vieira/simple-07", "--backend", "pybullet", "--json"]
    command = [sys.executable, "-c", program, *arguments]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=120)
    assert json.loads(done.stdout)["status"] == "retrieved"
    assert "pybullet build time" not in done.stderr


@pytest.fixture
def baxter() -> Any:
    pytest.importorskip("pinocchio")
    from phframe.arms.baxter import Baxter

    return Baxter(Baxter.options_type())


@pytest.mark.needs_baxter
def test_baxter_stands_still_and_has_its_fingertip_where_forward_says(baxter: Any) -> None:
    world = world_of(cylinder("o", 0.3, MIDDLE), TARGET, arm=baxter)
    for _ in range(500):
        world.engine.advance()
    assert np.abs(world.engine.arm().joints - baxter.home).max() < 1e-6
    tip = compose(world.base_pose.pose, baxter.forward(world.engine.arm().joints))
    assert np.allclose(world.engine.arm().gripper, [tip[0], tip[1], yaw_of(tip)], atol=1e-5)


@pytest.mark.needs_baxter
def test_joints_carry_their_weight_besides_what_motors_give(baxter: Any) -> None:
    """With hardly any effort the arm stands still; where nothing carries its weight, it falls."""
    fallen = []
    for carried in (True, False):
        world = world_of(cylinder("o", 0.3, MIDDLE), TARGET, arm=baxter)
        assert world.engine.sags
        world.engine.sags = carried
        world.engine.cap(np.full(7, 0.05))
        for _ in range(100):
            world.engine.advance()
        fallen.append(float(np.abs(world.engine.arm().joints - baxter.home).max()))
    assert fallen[0] < 1e-3
    assert fallen[1] > 0.1


def test_an_arm_that_moves_level_has_no_weight_to_carry() -> None:
    assert not world_of(cylinder("o", 0.3, MIDDLE), TARGET).engine.sags


def test_worlds_that_nobody_closes_give_their_clients_back() -> None:
    clients = set()
    for _ in range(5):
        world = world_of(cylinder("o", 0.3, MIDDLE), TARGET)
        clients.add(world.engine.client)
        del world
    assert len(clients) < 5
