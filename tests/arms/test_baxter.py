"""Baxter's kinematics against Rethink Robotics' own model, in every library that loads our URDF, and its inverse."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")

from phframe.arms.baxter import BaxterOptions
from phframe.arms.baxter.model import Side, mirrored
from phframe.core import ArmError, FloatArray, OptionError, Shelf, compose, inverse, planar_pose
from tests.arms.baxter_arm import GOLDEN, SIDES, as_matrix, baxter, fingertip

pytestmark = pytest.mark.needs_baxter
LEFT = baxter("left")
SHELF = Shelf(0.594, 0.584)
FORWARD = pytest.mark.parametrize("golden", GOLDEN["forward"], ids=lambda golden: f"{golden['pose']} {golden['side']}")
JOINTS = st.tuples(*(st.floats(joint.lower, joint.upper) for joint in LEFT.joints))


def over_shelf(x: float, y: float, yaw: float) -> FloatArray:
    """A level fingertip in the gripper plane, seen from the base of the left arm; y from the middle of the shelf."""
    base = inverse(LEFT.default_base_pose(SHELF).pose)
    return compose(base, planar_pose(x, SHELF.width / 2.0 + y, LEFT.shape.height, np.radians(yaw)))


@FORWARD
def test_forward_is_that_of_the_real_robot(golden: dict[str, Any]) -> None:
    found = as_matrix(baxter(golden["side"]).forward(golden["q"]))
    np.testing.assert_allclose(found, fingertip(golden["base_gripper"]), atol=1e-5)


@pytest.mark.needs_mujoco
@FORWARD
def test_forward_in_mujoco(golden: dict[str, Any]) -> None:
    mujoco = pytest.importorskip("mujoco")
    arm = baxter(golden["side"])
    keep = '<mujoco><compiler fusestatic="false"/></mujoco></robot>'
    model = mujoco.MjModel.from_xml_string(arm.urdf().replace("</robot>", keep))
    data = mujoco.MjData(model)
    for joint, value in zip(arm.joints, golden["q"], strict=True):
        data.joint(joint.name).qpos = value
    mujoco.mj_kinematics(model, data)
    tip, found = data.body(arm.tip_link), np.eye(4)
    found[:3, :3], found[:3, 3] = tip.xmat.reshape(3, 3), tip.xpos
    np.testing.assert_allclose(found, fingertip(golden["base_gripper"]), atol=1e-5)


@pytest.mark.needs_pybullet
@FORWARD
def test_forward_in_pybullet(golden: dict[str, Any], tmp_path: Path) -> None:
    bullet = pytest.importorskip("pybullet")
    arm, file = baxter(golden["side"]), tmp_path / "baxter.urdf"
    file.write_text(arm.urdf(), "utf-8")
    client = bullet.connect(bullet.DIRECT)
    try:
        body = bullet.loadURDF(str(file), useFixedBase=True, physicsClientId=client)
        count = bullet.getNumJoints(body, physicsClientId=client)
        infos = [bullet.getJointInfo(body, number, physicsClientId=client) for number in range(count)]
        numbers = {info[1].decode(): info[0] for info in infos}
        links = {info[12].decode(): info[0] for info in infos}
        for joint, value in zip(arm.joints, golden["q"], strict=True):
            bullet.resetJointState(body, numbers[joint.name], value, physicsClientId=client)
        state = bullet.getLinkState(body, links[arm.tip_link], computeForwardKinematics=True, physicsClientId=client)
    finally:
        bullet.disconnect(client)
    x, y, z, w = state[5]
    found = as_matrix(np.array([*state[4], w, x, y, z]))
    # The frame of the link itself: items 4 and 5; items 0 and 1 are those of its centre of mass.
    np.testing.assert_allclose(found, fingertip(golden["base_gripper"]), atol=1e-5)


@pytest.mark.parametrize("golden", GOLDEN["level"], ids=lambda golden: str(golden["target"]))
def test_level_poses_are_reproduced(golden: dict[str, Any]) -> None:
    wanted = fingertip(golden["base_gripper"])
    np.testing.assert_allclose(as_matrix(LEFT.forward(golden["q"])), wanted, atol=2e-4)
    x, y, z = golden["target"]
    level = planar_pose(x, y, z, np.radians(golden["yaw"]))
    flipped = compose(level, np.array([0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))
    sought = level if wanted[2, 2] > 0.0 else flipped
    found = LEFT.inverse(sought, golden["q"])
    assert found is not None
    np.testing.assert_allclose(as_matrix(LEFT.forward(found)), as_matrix(sought), atol=1e-8)
    assert float(np.abs(found - golden["q"]).max()) < 0.01, "near the seed"


@given(JOINTS)
@settings(max_examples=50, deadline=None)
def test_the_arms_are_mirror_images(q: tuple[float, ...]) -> None:
    left, right = LEFT.forward(q), baxter("right").forward(mirrored(q))
    reflected = right * [1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0]
    # A mirror image of a frame, with its y axis turned back: x and z turn the other way.
    same = reflected * [1.0, 1.0, 1.0, *[np.sign(reflected[3:] @ left[3:]) or 1.0] * 4]
    np.testing.assert_allclose(same, left, atol=1e-9)


@given(JOINTS)
@settings(max_examples=50, deadline=None)
def test_inverse_stays_with_a_seed_that_is_a_solution(q: tuple[float, ...]) -> None:
    found = LEFT.inverse(LEFT.forward(q), q)
    assert found is not None
    assert float(np.abs(found - q).max()) < 1e-4
    assert LEFT.within_limits(found)


def grid() -> list[FloatArray]:
    """Level poses over the shelf, all of which the real arm can take."""
    return [
        over_shelf(x, y, yaw) for yaw in (-15.0, 0.0, 15.0) for y in np.linspace(-0.2, 0.2, 5) for x in (0.1, 0.25, 0.4)
    ]


def test_inverse_finds_level_poses_all_over_the_shelf_from_scratch() -> None:
    solved = [LEFT.inverse(pose) for pose in grid()]
    for pose, q in zip(grid(), solved, strict=True):
        assert q is not None, pose
        assert LEFT.within_limits(q)
        np.testing.assert_allclose(as_matrix(LEFT.forward(q)), as_matrix(pose), atol=1e-8)
    again = [LEFT.inverse(pose) for pose in grid()]
    assert [q.tobytes() for q in solved if q is not None] == [q.tobytes() for q in again if q is not None]


@pytest.mark.parametrize("y", np.linspace(-0.15, 0.15, 5))
def test_a_straight_insertion_is_followed_to_half_a_metre(y: float) -> None:
    reach = LEFT.straight_reach(SHELF, LEFT.default_base_pose(SHELF))
    assert reach.depth(SHELF.width / 2.0 + y, LEFT.shape.min_opening, 0.5) == 0.5


def test_poses_that_no_arm_has_are_told() -> None:
    assert LEFT.inverse(planar_pose(3.0, 0.0, 0.3)) is None
    assert LEFT.inverse(planar_pose(-0.6, -0.6, 0.3)) is None
    with pytest.raises(ArmError, match=r"7 finite joint values \(left_s0, "):
        LEFT.forward([0.0] * 6)
    with pytest.raises(ArmError, match="quaternion"):
        LEFT.inverse(np.zeros(7))
    with pytest.raises(ArmError, match="7 finite joint values"):
        LEFT.inverse(LEFT.forward(LEFT.home), [np.nan] * 7)


def test_an_arm_that_baxter_has_not_is_told() -> None:
    with pytest.raises(OptionError, match="arm baxter: option 'side' is 'middle'"):
        BaxterOptions.parse({"side": "middle"}, "arm baxter")


@pytest.mark.parametrize("side", SIDES)
def test_home_is_level_before_the_mouth(side: Side) -> None:
    arm = baxter(side)
    tip = compose(arm.default_base_pose(SHELF).pose, arm.forward(arm.home))
    sign = 1.0 if side == "left" else -1.0
    wanted = planar_pose(-0.03, SHELF.width / 2.0 + sign * 0.1, 0.05)
    np.testing.assert_allclose(as_matrix(tip), as_matrix(wanted), atol=1e-5)
    lower, upper = np.array([[joint.lower, joint.upper] for joint in arm.joints]).T
    assert float(np.minimum(arm.home - lower, upper - arm.home).min()) > 0.1, "room at every limit"


@pytest.mark.parametrize("side", SIDES)
def test_the_default_base_pose_is_the_measured_one(side: Side) -> None:
    arm = baxter(side)
    mouth = compose(inverse(arm.default_base_pose(SHELF).pose), planar_pose(0.0, SHELF.width / 2.0, 0.0))
    np.testing.assert_allclose(mouth[:3], [0.675, 0.35 if side == "left" else -0.35, 0.2], atol=1e-12)
