"""Grippers, joints and limits of others become what an arm drives, or are refused in one line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import phframe.urdf
from phframe.core import ArmError
from phframe.urdf.description import ArmDescription, read_description
from phframe.urdf.driven import driven_robot, placements
from phframe.urdf.model import Mimic, Robot
from phframe.urdf.outlines import gripper_outlines
from phframe.urdf.reader import read_robot
from phframe.urdf.writer import robot_urdf

EXAMPLE = Path(phframe.urdf.__file__).parents[1] / "arms" / "example"
DESCRIPTION, _ = read_description(EXAMPLE / "arm.yaml")
TEXT = (EXAMPLE / "robot.urdf").read_text("utf-8")
FINGERS = ("left_slide", "right_slide")
RIGHT = """<axis xyz="0.0 -1.0 0.0" />
    <limit lower="0.0" upper="0.04" velocity="0.1" effort="20.0" />
    <mimic joint="left_slide" multiplier="1" offset="0" />"""
LEFT = """<axis xyz="0.0 1.0 0.0" />
    <limit lower="0.0" upper="0.04" velocity="0.1" effort="20.0" />
"""


def right(axis: float, lower: float, upper: float, mimic: str = "") -> str:
    """The right finger's joint in other conventions."""
    assert RIGHT in TEXT
    limit = f'<limit lower="{lower}" upper="{upper}" velocity="0.1" effort="20"/>'
    return TEXT.replace(RIGHT, f'<axis xyz="0 {axis} 0"/>{limit}{mimic}')


def with_leader(text: str) -> str:
    """Both fingers follow a third joint, which turns a link of its own."""
    leader = """<link name="crank"/><joint name="crank" type="revolute"><parent link="palm"/><child link="crank"/>
    <limit lower="0" upper="0.8" velocity="1" effort="1"/></joint></robot>"""
    left = LEFT + '<mimic joint="crank" multiplier="0.05" offset="0"/>'
    return text.replace(LEFT, left, 1).replace("</robot>", leader)


def driven(text: str, **changes: Any) -> Robot:
    return driven_robot(DESCRIPTION.model_copy(update=changes), read_robot(text))


def opening(robot: Robot) -> list[float]:
    """Between the fingers' inner faces with the joints of both at the lower limits, and at the upper ones (m)."""
    gaps = []
    for name in ("lower", "upper"):
        places = []
        for finger in FINGERS:
            joint = robot.joint(finger)
            assert joint.joint is not None
            place = placements(robot, "fingertip", [finger])[joint.child]
            move = getattr(joint.joint, name) - joint.joint.lower
            places.append(float((place[:3, 3] + place[:3, :3] @ np.array(joint.axis) * move)[1]))
        gaps.append(places[0] - places[1] - 0.012)
    return gaps


@pytest.mark.parametrize(
    "text",
    [
        TEXT,
        right(1.0, -0.04, 0.0, '<mimic joint="left_slide" multiplier="-1"/>'),
        right(-1.0, 0.0, 0.04),
        right(1.0, -0.04, 0.0),
        with_leader(right(1.0, -0.04, 0.0, '<mimic joint="crank" multiplier="-0.05"/>')),
        with_leader(right(-1.0, 0.0, 0.04, '<mimic joint="left_slide"/>')),
    ],
    ids=["ours", "multiplier -1", "not coupled", "not coupled, negative", "by a third joint", "in a chain"],
)
def test_fingers_open_upwards_together_however_they_count(text: str) -> None:
    robot = driven(text)
    assert opening(robot) == pytest.approx([0.0, 0.08])
    follower = robot.joint("right_slide").mimic
    assert follower in (Mimic("left_slide"), None)
    assert robot.joint("left_slide").mimic is None
    assert set(robot.moving) == {*DESCRIPTION.joints, *FINGERS} | ({"crank"} & set(robot.moving))
    if "crank" in robot.moving:
        crank = robot.joint("crank").mimic
        assert crank is not None
        assert (crank.joint, crank.offset) == ("left_slide", 0.0)
        assert crank.multiplier == pytest.approx(20.0), "it moves as it did before"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (right(1.0, -0.04, 0.0, '<mimic joint="left_slide"/>'), "do not open evenly: as the left one opens by 1 mm"),
        (right(-1.0, 0.0, 0.04, '<mimic joint="left_slide" multiplier="0.5"/>'), "the right one opens by 0.5 mm"),
        (right(-1.0, 0.0, 0.04, '<mimic joint="left_slide" offset="0.01"/>'), "from 0.01, and its closed place is 0"),
        (right(-1.0, 0.0, 0.03), "the fingers travel 0.04 and 0.03 m"),
        (right(-1.0, 0.0, 0.04, '<mimic joint="elbow"/>'), "follow 'left_slide' and 'elbow'"),
        (right(-1.0, 0.0, 0.04, '<mimic joint="thumb"/>'), "follows 'thumb', which is no joint that moves"),
        (right(-1.0, 0.0, 0.04, '<mimic joint="right_slide"/>'), "follows itself"),
        (TEXT.replace(RIGHT, RIGHT.replace("0.0 -1.0 0.0", "0 0 1")), r"slides along \(0, 0, 1\) in the fingertip frame"),
        (TEXT.replace(LEFT, LEFT.replace('velocity="0.1"', "")), "'left_slide' of the URDF has the velocity 0"),
        (TEXT.replace('name="wrist_roll" type="revolute"', 'name="wrist_roll" type="continuous"').replace(
            '<limit lower="-3.0" upper="3.0" velocity="3.0" effort="10.0" />', ""), "'wrist_roll' of the URDF has the velocity"),
    ],
)  # fmt: skip
def test_fingers_that_do_not_open_evenly_are_refused(text: str, said: str) -> None:
    with pytest.raises(ArmError, match=said) as caught:
        driven(text)
    assert "\n" not in str(caught.value)


def test_driven_joints_follow_no_other() -> None:
    text = TEXT.replace(
        '<limit lower="0.0" upper="2.6" velocity="2.0" effort="30.0" />',
        '<limit lower="0.0" upper="2.6" velocity="2.0" effort="30.0" /><mimic joint="shoulder"/>',
    )
    with pytest.raises(ArmError, match="'elbow' follows another"):
        driven(text)


def test_joints_that_are_not_driven_are_fixed_and_need_no_limits() -> None:
    more = "".join(
        f'<link name="{name}"/><joint name="{name}" type="{kind}"><parent link="base"/><child link="{name}"/>'
        f'<axis xyz="0 0 1"/>{limit}</joint>'
        for name, kind, limit in (
            ("wheel", "continuous", ""),
            ("lever", "revolute", '<limit lower="0.5" upper="1" velocity="0" effort="0"/>'),
            ("drawer", "prismatic", ""),
        )
    )
    robot = driven(TEXT.replace("</robot>", more + "</robot>"))
    assert set(robot.moving) == {*DESCRIPTION.joints, *FINGERS}
    assert [robot.parent_joints[name].rpy[2] for name in ("wheel", "lever", "drawer")] == [0.0, 0.5, 0.0]
    assert robot_urdf(read_robot(robot_urdf(robot))) == robot_urdf(robot)


def test_a_driven_joint_that_turns_without_end_is_kept_to_half_a_turn() -> None:
    text = TEXT.replace('name="wrist_roll" type="revolute"', 'name="wrist_roll" type="continuous"')
    roll = driven(text).joint("wrist_roll")
    assert roll.joint is not None
    assert (roll.kind, roll.joint.lower, roll.joint.upper) == ("revolute", -np.pi, np.pi)


def outlines(text: str, **changes: Any) -> dict[str, Any]:
    robot = driven(text, **changes)
    return {outline.part: outline for outline in gripper_outlines(robot, "fingertip", FINGERS)}


def test_fingers_that_meet_at_the_middle_are_fingers() -> None:
    pads = TEXT.replace('<box size="0.08 0.012 0.03" />', '<cylinder radius="0.006" length="0.03" />')
    for text in (TEXT, pads, TEXT.replace("0.08 0.012 0.03", "0.08 0.0135 0.03")):
        found = outlines(text)
        assert found["left finger"].side == 1
        assert found["left finger"].vertices[:, 1].min() == pytest.approx(0.0, abs=1e-9)
        assert found["right finger"].vertices[:, 1].max() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("0.08 0.012 0.03", "0.08 0.02 0.03"), "reaches past the middle when it is closed, by 0.004 m"),
        (('xyz="0.06 0.006 0.0"', 'xyz="0.06 -0.03 0.0"'), "is on the other side of the fingertip"),
    ],
)
def test_fingers_that_are_not_where_fingers_are_are_refused(change: tuple[str, str], said: str) -> None:
    assert change[0] in TEXT
    with pytest.raises(ArmError, match=said):
        outlines(TEXT.replace(*change))


def test_fingers_named_the_wrong_way_round_are_refused() -> None:
    robot = driven(TEXT, fingers=("right_slide", "left_slide"))
    with pytest.raises(ArmError, match="the left one, at positive y, comes first"):
        gripper_outlines(robot, "fingertip", ("right_slide", "left_slide"))


def test_a_finger_without_collision_geometry_is_refused() -> None:
    begin = TEXT.index('<collision name="left_finger')
    text = TEXT[:begin] + TEXT[TEXT.index("</collision>", begin) + len("</collision>") :]
    with pytest.raises(ArmError, match="the left finger, link 'left_finger', has no collision geometry"):
        outlines(text)


def test_the_srdf_says_what_may_collide(tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text(TEXT, "utf-8")
    (tmp_path / "arm.yaml").write_text(
        (EXAMPLE / "arm.yaml").read_text("utf-8").replace("overlapping: []", "overlapping: [[base, forearm]]")
        + "srdf: robot.srdf\n",
        "utf-8",
    )
    (tmp_path / "robot.srdf").write_text(
        '<robot name="r"><disable_collisions link1="base" link2="hand" reason="Never"/></robot>', "utf-8"
    )
    description, robot = read_description(tmp_path / "arm.yaml")
    assert description.allowed_collisions == (("base", "forearm"), ("base", "hand"))
    driven_robot(description, robot)
    for text, said in (
        ("<robot", "the SRDF is not XML"),
        ('<r><disable_collisions link1="a"/></r>', "lacks link1 or link2"),
    ):
        (tmp_path / "robot.srdf").write_text(text, "utf-8")
        with pytest.raises(Exception, match=said):
            read_description(tmp_path / "arm.yaml")
    (tmp_path / "robot.srdf").write_text('<r><disable_collisions link1="base" link2="x"/></r>', "utf-8")
    with pytest.raises(ArmError, match="the SRDF names the link 'x', which the URDF has not"):
        driven_robot(*read_description(tmp_path / "arm.yaml"))


def test_keys_are_those_of_the_file_and_of_the_code() -> None:
    given = DESCRIPTION.model_dump(by_alias=True)
    assert given["postures"]
    assert ArmDescription.model_validate(given) == DESCRIPTION
    assert ArmDescription(**DESCRIPTION.model_dump()) == DESCRIPTION


@pytest.mark.parametrize(("finger", "sign"), [("left_slide", 1.0), ("right_slide", -1.0)])
def test_what_follows_one_of_two_independent_fingers_moves_with_it(finger: str, sign: float) -> None:
    more = f"""<link name="cover"/><joint name="cover" type="prismatic"><parent link="palm"/><child link="cover"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/>
    <mimic joint="{finger}" multiplier="0.5" offset="0.01"/></joint></robot>"""
    robot = driven(right(1.0, -0.04, 0.0).replace("</robot>", more))
    assert robot.joint("right_slide").mimic is None
    assert robot.joint("cover").mimic == Mimic(finger, 0.5 * sign, 0.01), "the right finger counts backwards"
