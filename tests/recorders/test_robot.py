"""The robot that is drawn stands where the arm's own kinematics says, and looks like its URDF."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from phframe.core import ArmError, ArmModel, ArmState, BasePose, InputError, LinkMesh, State, compose
from phframe.recorders import palette
from phframe.recorders.arm_bodies import Outlines, bodies_of
from phframe.recorders.bodies import Primitive, Surface, normals, prism
from phframe.recorders.frames import Frames
from phframe.recorders.robot import drawn_robot
from phframe.registry import Kind, create
from tests.recorders.synthetic_episode import SCENE, mounted

BASE = BasePose(-0.7, 0.2, -0.15, 0.3).pose
FOLLOWER = """<robot name="r">
<link name="a"/><link name="b"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
<link name="c"><visual><geometry><mesh filename="c.stl"/></geometry></visual>
<collision><origin xyz="0 0 1" rpy="0 1.5707963 0"/><geometry><cylinder radius="0.2" length="3"/></geometry></collision></link>
<joint name="u" type="continuous"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 0 2"/>
<mimic joint="s" multiplier="-2" offset="0.5"/></joint>
<joint name="s" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint></robot>"""


def same_pose(a: np.ndarray, b: np.ndarray) -> None:
    np.testing.assert_allclose(a[:3], b[:3], atol=1e-9)
    np.testing.assert_allclose(abs(a[3:] @ b[3:]), 1.0, atol=1e-9)


@pytest.mark.parametrize(
    "name", ["planar", *(pytest.param(n, marks=pytest.mark.needs_baxter) for n in ("baxter", "articulated"))]
)
def test_the_fingertip_is_where_the_arm_says(name: str) -> None:
    if name != "planar":
        pytest.importorskip("pinocchio")
    arm: ArmModel = create(Kind.ARM, name)
    lower, upper = np.array([[joint.lower, joint.upper] for joint in arm.joints]).T
    joints = np.random.default_rng(0).uniform(lower, upper, (20, len(lower)))
    robot = drawn_robot(arm.urdf())
    placed = robot.poses(BASE, dict(zip([joint.name for joint in arm.joints], joints.T, strict=True)))
    for q, pose in zip(joints, placed[arm.tip_link], strict=True):
        same_pose(pose, compose(BASE, arm.forward(q)))
    assert len(placed[robot.robot.root]) == 1, "what no joint moves is said once"


def test_a_joint_that_follows_moves_with_its_leader() -> None:
    robot = drawn_robot(FOLLOWER)
    placed = robot.poses(np.array([0.0, 0, 0, 1, 0, 0, 0]), {"s": np.array([0.0, 0.25])})
    turned = Rotation.from_quat(placed["c"][:, [4, 5, 6, 3]]).as_rotvec()
    np.testing.assert_allclose(turned, np.array([[0, 0, 0.5], [0, 0, 0]]), atol=1e-9)
    np.testing.assert_allclose(placed["c"][:, :3], np.array([[1, 0, 0], [1, 0.25, 0]]), atol=1e-9)


def test_links_look_like_their_visuals_or_else_like_what_collides() -> None:
    bodies = {body.name: body.pieces for body in drawn_robot(FOLLOWER, bright=["c"]).bodies}
    assert set(bodies) == {"b", "c"}
    (sphere,), (cylinder,) = bodies["b"], bodies["c"]
    assert sphere.shape == Primitive("sphere", (0.1,))
    assert isinstance(cylinder.shape, Primitive)
    assert (cylinder.shape.kind, cylinder.shape.size) == ("cylinder", (0.2, 3.0))
    np.testing.assert_allclose(cylinder.shape.pose[:3], [0, 0, 1])
    assert (sphere.color, cylinder.color) == (palette.LINK, palette.FINGER)


def test_meshes_replace_the_primitives_of_their_link_only() -> None:
    mesh = LinkMesh("b", np.eye(3), np.array([[0, 1, 2]]), (1.0, 0.5, 0.0))
    bodies = {body.name: body.pieces for body in drawn_robot(FOLLOWER, [mesh, mesh]).bodies}
    assert [piece.color for piece in bodies["b"]] == [(255, 128, 0, 255)] * 2
    assert isinstance(bodies["b"][0].shape, Surface)
    assert isinstance(bodies["c"][0].shape, Primitive)


def test_meshes_for_no_link_are_refused() -> None:
    with pytest.raises(ArmError, match="meshes for d, which the URDF has no link for"):
        drawn_robot(FOLLOWER, [LinkMesh("d", np.eye(3), np.array([[0, 1, 2]]))])


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("no xml", "the URDF is not XML: syntax error"),
        (
            '<robot><link name="a"/><joint name="j" type="fixed"><parent link="a"/></joint></robot>',
            "joint 'j' of the URDF has no link",
        ),
        ('<robot><link name="a"><visual><geometry><box size="1 x 1"/></geometry></visual></link></robot>', "'x'"),
        ('<robot><link name="a"/><link name="b"/></robot>', "must make one tree"),
    ],
)
def test_a_broken_urdf_is_one_line(text: str, why: str) -> None:
    with pytest.raises(ArmError, match=why) as caught:
        drawn_robot(text)
    assert "\n" not in str(caught.value)


def test_links_and_outlines_of_the_planar_arm_are_in_the_same_place() -> None:
    x, y, yaw, opening = 0.2, 0.35, 0.4, 0.05
    links, outlines = (bodies_of(mounted(by_joints=by_joints), SCENE) for by_joints in (True, False))
    base_pose = mounted().base_pose
    joints = np.array([x - base_pose.x, y - base_pose.y, yaw])
    initial = SCENE.initial_state()
    state = State(initial.poses, initial.conditions, None, ArmState(np.array([x, y, yaw]), opening, joints=joints))
    frames = Frames.gather(np.zeros(1), [state], outlines.parked)
    ours, theirs = links.poses(frames), outlines.poses(frames)
    same_pose(ours["fingertip"][0], theirs["link"][0])
    for side in ("left", "right"):
        same_pose(ours[f"{side}_finger_link"][0], theirs[f"{side} finger"][0])


def test_a_part_of_several_outlines_is_one_body_of_several_pieces() -> None:
    near, *others = mounted().shape.closed
    far = replace(near, vertices=near.vertices - [0.5, 0.0])
    bodies = {body.name: body for body in Outlines(replace(mounted().shape, closed=(near, far, *others)), SCENE).bodies}
    assert [len(body.pieces) for body in bodies.values()] == [2, 1, 1, 1]
    first, second = (piece.shape for piece in bodies[near.part].pieces)
    assert isinstance(first, Surface)
    assert isinstance(second, Surface)
    np.testing.assert_allclose(second.vertices, first.vertices - [0.5, 0.0, 0.0])


def test_a_parked_robot_is_at_home() -> None:
    arm = mounted(by_joints=True)
    bodies = bodies_of(arm, SCENE)
    frames = Frames.gather(np.zeros(1), [SCENE.initial_state()], bodies.parked)
    same_pose(bodies.poses(frames)["fingertip"][0], compose(arm.base_pose.pose, arm.model.forward(arm.model.home)))
    np.testing.assert_allclose(frames.grippers[0], [arm.base_pose.x, arm.base_pose.y, 0.0])


def test_a_prism_is_closed_and_faces_outwards() -> None:
    (outline, *_) = mounted().shape.closed
    solid = prism(outline)
    a, b, c = (solid.vertices[solid.triangles[:, i]] for i in range(3))
    volume = float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6.0
    length, width = np.ptp(outline.vertices, axis=0)
    assert volume == pytest.approx(length * width * (outline.top - outline.bottom))
    middle = solid.vertices.mean(axis=0)
    assert (np.einsum("ij,ij->i", normals(solid), solid.vertices - middle) > 0.0).all()


def test_a_mesh_must_hold_together() -> None:
    for vertices, triangles in ((np.eye(2), [[0, 1, 1]]), (np.eye(3), [[0, 1]]), (np.eye(3), [[0, 1, 3]])):
        with pytest.raises(InputError, match="mesh"):
            LinkMesh("b", vertices, np.array(triangles))
