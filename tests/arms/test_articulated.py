"""Another robot as data: a URDF and a description make an arm, and whatever is wrong with them is one clear line."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ruamel.yaml import YAML

pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")

from phframe.arms.articulated import DescribedArm, DescribedArmOptions
from phframe.core import (
    ArmError,
    BasePose,
    Cylinder,
    InputError,
    Joint,
    Scene,
    SceneObject,
    Shelf,
    compose,
    planar_pose,
)
from phframe.urdf.model import Link, Mimic, Robot, RobotJoint
from phframe.urdf.solids import Solid, of_solids
from phframe.urdf.writer import robot_urdf

pytestmark = pytest.mark.needs_baxter

SHELF = Shelf(0.5, 0.6)
BEHIND = {"part": "forearm", "widths": [[0.14, 0.05], [0.4, 0.1]], "bottom": -0.03, "top": 0.03}
BOX = Solid("box", (0.2, 0.06, 0.06), (0.1, 0.0, 0.0))
DESCRIPTION: dict[str, Any] = {
    "phframe": 1,
    "urdf": "robot.urdf",
    "joints": ["lift", "shoulder", "elbow", "wrist", "tilt", "roll"],
    "fingers": ["left_slide", "right_slide"],
    "tip": {"link": "palm", "at": [0.14, 0.0, 0.0], "rpy": [0.0, 0.0, 0.0]},
    "min_opening": 0.01,
    "home": [0.1, 1.2, -2.0, 0.8, 0.0, 0.0],
    "shelf": {"at": [0.5, 0.0, 0.0]},
    "height": 0.08,
    "behind": [BEHIND],
}
"""A lift with an arm of three parallel joints and a wrist of two more."""


def urdf(kind: str = "prismatic") -> str:
    """The robot: links 0.35, 0.3 and 0.1 m long, and a palm with two fingers that slide."""
    names = ("base", "tower", "upper", "fore", "hand", "knuckle", "palm", "left_finger", "right_finger")
    links = [
        Link.of_solids(name, of_solids(1.0, [BOX]), (BOX,) if name in ("upper", "fore") else ()) for name in names[:6]
    ]
    palm = (Solid("box", (0.04, 0.14, 0.05), (0.04, 0.0, 0.0)), Solid("cylinder", (0.03, 0.04), (0.0, 0.0, 0.0)))
    links.append(Link.of_solids("palm", of_solids(0.5, palm), palm))
    finger = Solid("box", (0.08, 0.02, 0.03), (0.04, 0.0, 0.0))
    links += [Link.of_solids(name, of_solids(0.05, [finger]), (finger,)) for name in names[7:]]
    turn = {"velocity": 2.0, "effort": 40.0}
    z, y, x = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)
    chain = [
        ("base", "tower", (0.0, 0.0, 0.0), Joint("lift", -0.2, 0.5, velocity=0.5, effort=300.0), "prismatic", z),
        ("tower", "upper", (0.05, 0.0, 0.0), Joint("shoulder", -2.5, 2.5, **turn), "revolute", z),
        ("upper", "fore", (0.35, 0.0, 0.0), Joint("elbow", -2.6, 2.6, **turn), "revolute", z),
        ("fore", "hand", (0.3, 0.0, 0.0), Joint("wrist", -2.5, 2.5, **turn), "revolute", z),
        ("hand", "knuckle", (0.05, 0.0, 0.0), Joint("tilt", -1.0, 1.0, **turn), "revolute", y),
        ("knuckle", "palm", (0.05, 0.0, 0.0), Joint("roll", -3.0, 3.0, **turn), "revolute", x),
    ]
    joints = [RobotJoint(a, b, at, joint=j, kind=k, axis=axis) for a, b, at, j, k, axis in chain]  # type: ignore[arg-type]
    for name, sign, follows in (("left", 1.0, ""), ("right", -1.0, "left_slide")):
        joint = Joint(f"{name}_slide", 0.0, 0.03, velocity=0.1, effort=20.0)
        at, axis = (0.06, sign * 0.015, 0.0), (0.0, sign, 0.0)
        mimic = Mimic(follows) if follows else None
        joints.append(RobotJoint("palm", f"{name}_finger", at, (0.0, 0.0, 0.0), joint, kind, axis, mimic))  # type: ignore[arg-type]
    return robot_urdf(Robot.of("lift_arm", links, joints))


def arm(folder: Path, text: str | None = None, **changes: Any) -> DescribedArm:
    (folder / "robot.urdf").write_text(urdf() if text is None else text, "utf-8")
    with (folder / "arm.yaml").open("w", encoding="utf-8") as file:
        YAML().dump({key: value for key, value in {**DESCRIPTION, **changes}.items() if value is not None}, file)
    return DescribedArm(DescribedArmOptions(description=folder / "arm.yaml"))


def test_a_robot_is_two_files(tmp_path: Path) -> None:
    robot = arm(tmp_path)
    assert [joint.name for joint in robot.joints] == DESCRIPTION["joints"]
    assert robot.joints[0].effort == 300.0
    np.testing.assert_allclose(robot.forward(np.zeros(6)), planar_pose(0.05 + 0.35 + 0.3 + 0.1 + 0.14, 0.0), atol=1e-12)
    assert robot.default_base_pose(SHELF) == BasePose(-0.5, 0.3, 0.0, 0.0)
    wanted = planar_pose(0.6, 0.1, 0.08, 0.3)
    found = robot.inverse(wanted, robot.home)
    assert found is not None
    np.testing.assert_allclose(robot.forward(found), wanted, atol=1e-8)
    assert robot.inverse(planar_pose(0.6, 0.1, 0.9)) is None, "higher than the lift goes"


def test_its_outlines_come_from_its_collision_geometry_and_the_description(tmp_path: Path) -> None:
    shape = arm(tmp_path).shape
    by_part = {outline.part: outline for outline in shape.closed}
    assert set(by_part) == {"palm 0", "palm 1", "left finger", "right finger", "forearm"}
    left = by_part["left finger"].vertices
    np.testing.assert_allclose([left.min(axis=0), left.max(axis=0)], [[-0.08, 0.005], [0.0, 0.025]], atol=1e-9)
    round_ = by_part["palm 1"].vertices
    np.testing.assert_allclose([round_.min(axis=0), round_.max(axis=0)], [[-0.17, -0.03], [-0.11, 0.03]], atol=1e-4)
    np.testing.assert_allclose(by_part["forearm"].vertices[0], [-0.4, -0.1])
    assert (shape.insertion_width, shape.link_width) == pytest.approx((0.05, 0.2))
    assert (shape.min_opening, shape.max_opening) == pytest.approx((0.01, 0.07))


def test_a_shelf_that_stands_askew_is_where_it_is_described(tmp_path: Path) -> None:
    robot = arm(tmp_path, shelf={"at": [0.4, 0.2, -0.1], "yaw": 0.5})
    mouth = planar_pose(0.0, SHELF.width / 2.0, 0.0)
    base = robot.default_base_pose(SHELF).pose
    np.testing.assert_allclose(compose(base, planar_pose(0.4, 0.2, -0.1, 0.5)), mouth, atol=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"joints": ["lift", "hip"]}, "no moving joint 'hip'; there is: elbow, left_slide"),
        ({"home": [0.0]}, "home has 1 values for 6 joints"),
        ({"home": [9.0, 0.0, 0.0, 0.0, 0.0, 0.0]}, "at home lift is 9, beyond its limits -0.2 to 0.5"),
        ({"fingers": ["left_slide", "roll"]}, "joint 'roll' is named twice under 'joints' and 'fingers'"),
        ({"tip": None}, "no link 'fingertip': say under 'tip'"),
        ({"tip": {"link": "thumb", "at": [0, 0, 0]}}, "no link 'thumb'; there is: base, tower"),
        ({"tip": {"link": "palm", "at": [0, 0]}}, r"arm.yaml: line \d+: tip.at"),
        ({"height": float("nan")}, r"arm.yaml: line \d+: height"),
        ({"mount": 1}, r"arm.yaml: line \d+: mount: extra inputs are not permitted"),
        ({"phframe": 2}, r"arm.yaml: line \d+: phframe"),
        ({"urdf": "gone.urdf"}, "cannot read the URDF .*gone.urdf: no such file"),
        ({"urdf": None}, "urdf must name"),
        ({"joints": [*DESCRIPTION["joints"][:5], "tilt"]}, "joint 'tilt' is named twice"),
        ({"fingers": ["left_slide", "left_slide"]}, "joint 'left_slide' is named twice"),
        ({"postures": [[0.0, 1.0]]}, "a seed configuration has 2 values for 6 joints"),
        ({"postures": [[9.0, 0.0, 0.0, 0.0, 0.0, 0.0]]}, "at a seed configuration lift is 9, beyond its limits"),
        ({"postures": [[float("nan")] * 6]}, r"arm.yaml: line \d+: postures.0.0: .* finite"),
        (
            {"overlapping": [["palm", "thumb"]]},
            "'overlapping' or the SRDF names the link 'thumb', which the URDF has not",
        ),
        ({"behind": [{**BEHIND, "widths": [[0.14, 0.05]]}]}, "widths: at least two pairs"),
        ({"behind": [{**BEHIND, "widths": [[0.4, 0.1], [0.14, 0.05]]}]}, "the nearest first"),
    ],
)
def test_a_description_that_cannot_be_is_told(tmp_path: Path, changes: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        arm(tmp_path, **changes).urdf()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the URDF is not XML"),
        ("<sdf/>", "begins with <sdf>, not with <robot>"),
        (urdf().replace('link="upper"', 'link="lower"', 1), "names the link 'lower', which does not exist"),
        (urdf().replace('type="revolute"', 'type="floating"', 1), "'floating'; an arm has joints that are fixed"),
        (urdf().replace('upper="2.5"', 'upper="nan"', 1), "'nan' where a finite number is needed"),
        (urdf().replace('upper="2.5"', 'upper="wide"', 1), "'wide' where a number is needed"),
        (
            urdf().replace('lower="-2.5" upper="2.5" ', "", 1),
            "'shoulder' of the URDF has no room between its limits 0 and 0",
        ),
        (urdf().replace('xyz="0.05 0.0 0.0"', 'xyz="0.05 0.0"', 1), "'0.05 0.0' where three numbers are needed"),
        (urdf("revolute"), "the finger joint 'left_slide' turns"),
        (urdf().replace('velocity="2.0"', 'velocity="0.0"', 1), "joint 'shoulder' of the URDF has the velocity 0"),
        (urdf().replace('lower="-2.5"', 'lower="2.5"', 1), "joint 'shoulder' of the URDF has no room between"),
    ],
)
def test_a_urdf_that_does_not_load_is_told(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ArmError, match=said):
        arm(tmp_path, text).urdf()


def test_a_list_is_no_description(tmp_path: Path) -> None:
    (tmp_path / "list.yaml").write_text("- 1", "utf-8")
    with pytest.raises(InputError, match="a description is made of keys and values"):
        DescribedArm(DescribedArmOptions(description=tmp_path / "list.yaml")).urdf()


@pytest.mark.parametrize(
    ("tip", "said"),
    [
        ((0.16, 0.0, 0.0), "the gripper's collision geometry ends 0.02 m behind the fingertip"),
        ((0.14, 0.1, 0.0), "the left finger, link 'left_finger', is on the other side of the fingertip"),
    ],
)
def test_a_tip_that_is_not_at_the_fingers_is_told(tmp_path: Path, tip: tuple[float, ...], said: str) -> None:
    robot = arm(tmp_path, tip={"link": "palm", "at": list(tip)})
    with pytest.raises(ArmError, match=said):
        _ = robot.shape


def test_a_hand_without_collision_geometry_is_told(tmp_path: Path) -> None:
    root = ET.fromstring(urdf())
    for link in root.findall("link"):
        for element in link.findall("collision"):
            link.remove(element)
    robot = arm(tmp_path, ET.tostring(root, encoding="unicode"))
    with pytest.raises(ArmError, match="the left finger, link 'left_finger', has no collision geometry"):
        _ = robot.shape


def test_files_that_are_not_there_or_not_text_are_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read .*none\.yaml"):
        DescribedArm(DescribedArmOptions(description=tmp_path / "none.yaml")).urdf()
    (tmp_path / "bad.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not UTF-8"):
        DescribedArm(DescribedArmOptions(description=tmp_path / "bad.yaml")).urdf()
    (tmp_path / "open.yaml").write_text("joints: [", "utf-8")
    with pytest.raises(InputError, match="not valid YAML"):
        DescribedArm(DescribedArmOptions(description=tmp_path / "open.yaml")).urdf()


def test_the_example_is_an_arm_that_solves_a_scene() -> None:
    import phframe

    example = DescribedArm(DescribedArmOptions())
    tip = compose(example.default_base_pose(SHELF).pose, example.forward(example.home))
    np.testing.assert_allclose(tip, planar_pose(-0.1, SHELF.width / 2.0, 0.08), atol=1e-5)
    episode = phframe.solve("vieira/simple-01", arm="articulated")
    assert episode.status == "retrieved"


@pytest.mark.needs_mujoco
@pytest.mark.needs_ompl
def test_the_example_solves_a_scene_by_its_joints() -> None:
    for library in ("mujoco", "ompl", "toppra"):
        pytest.importorskip(library)
    import phframe

    episode = phframe.solve("vieira/simple-07", backend="mujoco", arm="articulated")
    assert (episode.status, episode.clean) == ("retrieved", True)
    assert all(step.motion.complete and step.motion.tracking_error < 0.01 for step in episode.steps)


@pytest.mark.needs_ompl
def test_closed_fingers_may_touch_one_another() -> None:
    pytest.importorskip("ompl")
    from phframe.motion.coal_ import CollisionModel
    from phframe.motion.collision_checking import CollisionContext

    example = DescribedArm(DescribedArmOptions())
    description = example.description.model_copy(update={"overlapping": ()})
    scene = Scene("shelf", SHELF, (SceneObject("t", Cylinder(0.03), (0.3, 0.3)),), "t")
    model = CollisionModel(example, description, scene.shelf, scene.objects, example.default_base_pose(SHELF), 0.0, 0.0)
    checker = model.checker(CollisionContext(scene.initial_state(), opening=0.0))
    assert checker.collisions(example.home) == ()
    folded = np.array([0.0, 0.5, 2.6, 0.0, 0.0, 0.0])
    assert ("base", "forearm") in checker.collisions(folded), "whatever else meets does collide"
