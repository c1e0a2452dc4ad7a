"""URDFs as others write them: read whole, written again the same, refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from phframe.core import ArmError
from phframe.urdf.convex_hull import ConvexHull
from phframe.urdf.model import MeshFile, Mimic
from phframe.urdf.reader import TURN, read_robot
from phframe.urdf.writer import robot_urdf
from tests.urdf.meshes import write_box

FOREIGN = """<robot name="foreign"><material name="red"><color rgba="1 0 0 1"/></material>
<link name="a"><visual><geometry><mesh filename="package://gone/a.dae" scale="2 2 2"/></geometry>
 <material name="red"/></visual>
 <collision name="c"><geometry><mesh filename="a.obj" scale="0.5 1 1"/></geometry></collision>
 <collision name="c"><origin xyz="0 0 1" rpy="0 1.5 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="b"><collision name="c"><geometry><cylinder radius="0.1" length="2"/></geometry></collision>
 <inertial><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><mass value="2"/>
 <inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="c"/><link name="d"/>
<joint name="spin" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 3 4"/>
 <dynamics damping="0.1" friction="0.2"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><limit velocity="1" effort="2" upper="0.1"/>
 <mimic joint="spin" multiplier="-2" offset="0.5"/></joint>
<joint name="screw" type="fixed"><parent link="c"/><child link="d"/></joint></robot>"""


def test_what_others_write_is_read_and_written_again(tmp_path: Path) -> None:
    write_box(tmp_path / "a.obj", (0.4, 0.2, 0.1))
    robot = read_robot(FOREIGN, tmp_path)
    spin, slide = robot.joint("spin"), robot.joint("slide")
    assert (spin.kind, spin.axis, spin.damping, spin.friction) == ("continuous", (0.0, 0.6, 0.8), 0.1, 0.2)
    assert spin.joint is not None
    assert (spin.joint.lower, spin.joint.upper, spin.joint.velocity) == (-TURN, TURN, 0.0), (
        "no limit is needed to be read"
    )
    assert slide.mimic == Mimic("spin", -2.0, 0.5)
    assert slide.axis == (1.0, 0.0, 0.0)
    assert robot.parent_joints["d"].name == "screw"
    hull, _ = robot.collision_geometry["a"]
    assert isinstance(hull, ConvexHull)
    np.testing.assert_allclose(np.ptp(hull.corners(), axis=0), [0.2, 0.2, 0.1])
    inertia = robot.links["b"].inertia
    assert inertia is not None
    np.testing.assert_allclose(np.diag(inertia.matrix), [2.0, 1.0, 2.5], atol=1e-12)
    (visual,) = robot.links["a"].visuals
    assert visual.color == (1.0, 0.0, 0.0, 1.0)
    assert visual.shape == MeshFile("package://gone/a.dae", (2.0, 2.0, 2.0)), "what is only seen need not be there"
    again = read_robot(robot_urdf(robot))
    assert again.parent_joints == robot.parent_joints
    assert [link.inertia for link in again.links.values()] == [link.inertia for link in robot.links.values()]
    assert again.hulls[0][1].vertices.tobytes() == hull.vertices.tobytes()
    assert robot_urdf(read_robot(robot_urdf(again))) == robot_urdf(again)
    names = [line.split('name="')[1].split('"')[0] for line in robot_urdf(robot).splitlines() if "<collision" in line]
    assert len(set(names)) == len(names) == 3, "engines want names that are unique in the robot"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('filename="a.obj"', 'filename="b.obj"', r"the mesh 'b\.obj' of the URDF is not there; looked in"),
        ("<sphere", "<capsule", "the collision geometry of link 'a' in the URDF is a 'capsule'; there is: box"),
        ('xyz="0 3 4"', 'xyz="0 0 0"', "joint 'spin' of the URDF has an axis of no length"),
        ('link name="d"', 'link name="c"', "more than one link 'c'"),
        ('joint name="screw"', 'joint name="spin"', "more than one joint 'spin'"),
        ('<parent link="a"/><child link="b"/>', '<parent link="c"/><child link="b"/>', "must make one tree"),
        ('mimic joint="spin"', 'mimic leader="spin"', "the mimic of joint 'slide' of the URDF has no joint"),
        ('mass value="2"', 'mass weight="2"', "the inertia of link 'b' of the URDF has no value"),
    ],
)
def test_what_cannot_be_read_is_one_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    write_box(tmp_path / "a.obj", (0.4, 0.2, 0.1))
    assert old in FOREIGN
    with pytest.raises(ArmError, match=said) as caught:
        read_robot(FOREIGN.replace(old, new), tmp_path)
    assert "\n" not in str(caught.value)
