"""Baxter's body: masses, inertias, limits and collision geometry as in the sources, in a URDF that every engine loads."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")

from phframe.arms.baxter import figures
from phframe.arms.baxter.model import Side
from phframe.core import FloatArray, Shelf
from phframe.urdf.model import CollisionGeometry, Mimic
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import Solid
from tests.arms.baxter_arm import SIDES, baxter
from tests.arms.collision_surface import CollisionSurface

pytestmark = pytest.mark.needs_baxter
BOTH = pytest.mark.parametrize("side", SIDES)

LIMITS = {
    "s0": (-1.70167993878, 1.70167993878, 1.5, 50.0),
    "s1": (-2.147, 1.047, 1.5, 100.0),
    "e0": (-3.05417993878, 3.05417993878, 1.5, 50.0),
    "e1": (-0.05, 2.618, 1.5, 50.0),
    "w0": (-3.059, 3.059, 4.0, 15.0),
    "w1": (-1.57079632679, 2.094, 4.0, 15.0),
    "w2": (-3.059, 3.059, 4.0, 15.0),
}
"""Lower, upper, velocity, effort: as in Rethink's model, but for the effort of s1."""


def masses(side: Side) -> dict[str, float]:
    root = ET.fromstring(baxter(side).urdf())
    return {link.get("name", ""): float(link.find("inertial/mass").get("value", "")) for link in root.iter("link")}  # type: ignore[union-attr]


def moments(element: ET.Element) -> FloatArray:
    found = element.find("inertial/inertia")
    assert found is not None
    xx, xy, xz, yy, yz, zz = (float(found.get(key, "")) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@BOTH
def test_joint_limits_are_the_real_ones(side: Side) -> None:
    joints = baxter(side).joints
    assert {j.name: (j.lower, j.upper, j.velocity, j.effort) for j in joints} == {
        f"{side}_{name}": limits for name, limits in LIMITS.items()
    }


@BOTH
def test_masses_are_those_of_the_source(side: Side) -> None:
    found = masses(side)
    working = [mass for link, mass in found.items() if link.startswith(f"{side}_") or link == "fingertip"]
    assert sum(working) == pytest.approx(20.07, abs=0.005), "an arm with its gripper"
    assert sum(found.values()) == pytest.approx(2 * sum(working) + 35.336455 + 60.86397744 + 0.547767 + 0.440171)


@BOTH
def test_inertias_are_those_of_bodies(side: Side) -> None:
    for link in ET.fromstring(baxter(side).urdf()).iter("link"):
        first, second, third = np.linalg.eigvalsh(moments(link))
        assert first > 0.0, link.get("name")
        assert third <= first + second, link.get("name")


def test_a_finger_is_as_hard_to_turn_as_its_size_says() -> None:
    root = ET.fromstring(baxter("left").urdf())
    (finger,) = (link for link in root.iter("link") if link.get("name") == "left_gripper_left_finger")
    # 30 g, most of it in a bar 0.108 m long, whose m l^2 / 12 is 2.9e-5; the source says 1e-2.
    assert 1e-5 < moments(finger)[2, 2] < 6e-5


COVERS: dict[tuple[str, str], tuple[str, tuple[float, ...]]] = {
    ("left_upper_forearm", "tube"): ("cylinder", (0.0742, 0.233)),
    ("left_lower_forearm", "barrel"): ("cylinder", (0.059, 0.168)),
    ("left_lower_forearm", "tube"): ("cylinder", (0.066, 0.113)),
    ("fingertip", "body"): ("box", (0.0534, 0.1055, 0.066)),
}
"""Sizes of what is inside the shelf, as measured on the real shells; the body seen from the fingertip."""


@pytest.mark.parametrize(("link", "part"), COVERS)
def test_collision_geometry_is_as_large_as_the_real_ones(link: str, part: str) -> None:
    (solid,) = (solid for solid in read_robot(baxter("left").urdf()).collision_geometry[link] if solid.part == part)
    kind, size = COVERS[link, part]
    assert isinstance(solid, Solid)
    assert solid.kind == kind
    np.testing.assert_allclose(solid.size, size, atol=5e-4)


@BOTH
def test_fingers_are_coupled_and_take_what_is_60_mm_wide(side: Side) -> None:
    arm = baxter(side)
    robot = read_robot(arm.urdf())
    left, right = (robot.joint(joint.name) for joint in arm.fingers.joints)
    assert left.joint is not None
    assert right.mimic == Mimic(left.joint.name)
    assert (arm.shape.min_opening, arm.shape.max_opening) == pytest.approx((0.035, 0.0767), abs=1e-4)
    gap = (
        left.at[1]
        + inner(robot.collision_geometry[arm.fingers.links[0]])
        - right.at[1]
        + inner(robot.collision_geometry[arm.fingers.links[1]])
    )
    assert gap == pytest.approx(arm.shape.min_opening, abs=1e-9)


def inner(solids: tuple[CollisionGeometry, ...]) -> float:
    """How near a pad is to the gripper's axis, from the finger's joint (m); negative where it is nearer than that."""
    (pad,) = (solid for solid in solids if solid.part == "pad")
    return float(min(pad.corners()[:, 1], key=abs)) * (1.0 if pad.at[1] > 0.0 else -1.0)


@BOTH
def test_the_idle_arm_does_not_move_and_keeps_out_of_the_way(side: Side) -> None:
    arm = baxter(side)
    robot, shelf = read_robot(arm.urdf()), Shelf(0.594, 0.584)
    moving = {connection.joint.name for connection in robot.parent_joints.values() if connection.joint}
    assert moving == {joint.name for joint in (*arm.joints, *arm.fingers.joints)}
    other = "right" if side == "left" else "left"
    idle = tuple(link for link in robot.collision_geometry if link.startswith(f"{other}_"))
    assert len(idle) == 10
    points = CollisionSurface(arm, arm.default_base_pose(shelf), idle).in_shelf(arm.home)
    outside = (points[:, 0] < -0.1) | (points[:, 1] < -0.3) | (points[:, 1] > shelf.width + 0.3)
    assert outside.all()


@BOTH
def test_at_home_the_arm_is_before_the_mouth_and_clear_of_the_body(side: Side) -> None:
    arm, shelf = baxter(side), Shelf(0.594, 0.584)
    distal = ("lower_elbow", "upper_forearm", "lower_forearm", "wrist")
    links = (*(f"{side}_{link}" for link in distal), "fingertip", *arm.fingers.links)
    base_pose = arm.default_base_pose(shelf)
    points = CollisionSurface(arm, base_pose, links).in_shelf(arm.home)
    assert float(points[:, 0].max()) < 0.0
    seen_from_base = points - [base_pose.x, base_pose.y, base_pose.z]
    for box in figures.TORSO_GEOMETRY:
        inside = (np.abs(seen_from_base - np.array(box.at)) < np.array(box.size) / 2.0).all(axis=1)
        assert not inside.any(), box.part


@pytest.mark.needs_mujoco
@BOTH
def test_mujoco_loads_it_without_a_warning(side: Side, capfd: pytest.CaptureFixture[str]) -> None:
    mujoco = pytest.importorskip("mujoco")
    spec = mujoco.MjSpec.from_string(baxter(side).urdf())
    model = spec.compile()
    assert model.nq == 9
    assert model.neq == 1, "the fingers are coupled"
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    assert int(data.warning.number.sum()) == 0
    captured = capfd.readouterr()
    assert (captured.out, captured.err) == ("", "")


@pytest.mark.needs_mujoco
@BOTH
def test_the_covers_overlap_nowhere_but_where_it_is_said(side: Side) -> None:
    mujoco = pytest.importorskip("mujoco")
    arm = baxter(side)
    keep = '<mujoco><compiler fusestatic="false"/></mujoco></robot>'
    model = mujoco.MjModel.from_xml_string(arm.urdf().replace("</robot>", keep))
    data = mujoco.MjData(model)
    names = [model.body(number).name for number in range(model.nbody)]
    said = {frozenset(pair) for pair in arm.description.allowed_collisions}
    assert all(link in read_robot(arm.urdf()).collision_geometry for pair in said for link in pair)
    parents = {frozenset((c.parent, c.child)) for c in read_robot(arm.urdf()).parent_joints.values()}
    for opening in (0.0, figures.FINGER_TRAVEL):
        values = {joint.name: value for joint, value in zip(arm.joints, arm.home, strict=True)}
        for name, value in {**values, **dict.fromkeys((j.name for j in arm.fingers.joints), opening)}.items():
            data.joint(name).qpos = value
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_collision(model, data)
        bodies = [model.geom_bodyid[[contact.geom1, contact.geom2]] for contact in data.contact if contact.dist < 0.0]
        found = {frozenset(names[body] for body in pair) for pair in bodies}
        assert found - said - parents == set()
        assert found & said, "what is said to overlap does"


@pytest.mark.needs_pybullet
@BOTH
def test_pybullet_loads_it_without_a_warning(side: Side, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bullet = pytest.importorskip("pybullet")
    file = tmp_path / "baxter.urdf"
    file.write_text(baxter(side).urdf(), "utf-8")
    client = bullet.connect(bullet.DIRECT)
    try:
        capfd.readouterr()
        body = bullet.loadURDF(str(file), useFixedBase=True, physicsClientId=client)
        captured = capfd.readouterr()
        assert (captured.out, captured.err) == ("", "")
        count = bullet.getNumJoints(body, physicsClientId=client)
        weights = [bullet.getDynamicsInfo(body, link, physicsClientId=client)[0] for link in range(count)]
    finally:
        bullet.disconnect(client)
    assert sum(weights) == pytest.approx(sum(masses(side).values()) - 35.336455), "all but the base, which is fixed"
