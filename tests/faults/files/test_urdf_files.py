"""URDFs in which anything is wrong: a robot that can be written, read again and measured, or one line."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

import phframe.arms
from phframe.core import ArmError, ArmModel
from phframe.urdf.description import read_description
from phframe.urdf.driven import driven_robot
from phframe.urdf.model import Robot
from phframe.urdf.outlines import gripper_outlines
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import Solid
from phframe.urdf.writer import robot_urdf
from tests.faults.files.spoiling import TEXTS, a_line, spoilt_text
from tests.faults.files.spoiling_xml import VALUES, spoilt_xml
from tests.trials import many, tried

FOLDER = Path(phframe.arms.__file__).parent / "example"
SEEN = '<visual><geometry><mesh filename="package://x/y.stl" scale="1 1 1"/></geometry></visual></link>'
TEXT = (FOLDER / "robot.urdf").read_text(encoding="utf-8").replace("</link>", SEEN, 1)
DESCRIPTION, _ = read_description(FOLDER / "arm.yaml")
PIECES = (
    *TEXTS,
    *VALUES,
    "<",
    ">",
    "/>",
    "</link>",
    "<!--",
    "]]>",
    "<!DOCTYPE x>",
    "&x;",
    "&#0;",
    "&#x110000;",
    '<link name="x"/>',
)


def judged(text: str) -> Robot | str:
    """The robot in a text, which must then be one; or what is wrong with it, a line."""
    try:
        robot = read_robot(text)
    except ArmError as error:
        return a_line(error)
    again = read_robot(robot_urdf(robot))
    assert list(again.links) == list(robot.links)
    assert [(each.name, each.parent, each.kind) for each in again.from_root] == [
        (each.name, each.parent, each.kind) for each in robot.from_root
    ]
    try:
        driven = driven_robot(DESCRIPTION, robot)
        outlines = gripper_outlines(driven, ArmModel.tip_link, DESCRIPTION.fingers)
    except ArmError as error:
        a_line(error)
    else:
        assert all(each.vertices.shape >= (3, 2) and np.isfinite(each.vertices).all() for each in outlines)
    for link in robot.links.values():
        assert all(min(each.size) > 0.0 for each in link.collision_geometry if isinstance(each, Solid))
    return robot


@settings(max_examples=many(80), deadline=None)
@given(spoilt_xml(TEXT))
def test_whatever_a_urdf_is_made_of_it_is_a_robot_or_one_line(text: str) -> None:
    tried("inputs: URDFs with elements changed")
    judged(text)


@settings(max_examples=many(40), deadline=None)
@given(spoilt_text(TEXT, PIECES))
def test_whatever_is_written_in_a_urdf_it_is_a_robot_or_one_line(text: str) -> None:
    tried("inputs: URDFs with a word or line changed")
    judged(text)


def test_half_of_a_character_is_one_line() -> None:
    assert isinstance(judged('<robot name="\ud800"/>'), str)


def test_a_finger_that_is_a_point_is_one_line() -> None:
    finger = TEXT.index("<collision", TEXT.index('<link name="left_finger">'))
    far = TEXT[:finger] + re.sub(r'(?<=xyz=")[^"]*', "1e19 1e19 0", TEXT[finger:], count=1)
    with pytest.raises(ArmError, match="has no extent seen from above"):
        gripper_outlines(driven_robot(DESCRIPTION, read_robot(far)), ArmModel.tip_link, DESCRIPTION.fingers)
