"""The planar arm: joints that are the pose, widths as set, and a URDF that any engine can load."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import ArmError, FloatArray, OptionError, Shelf, planar_pose
from phframe.testing import check_arm
from phframe.testing.arm.urdf_tree import UrdfTree

ARM = PlanarArm(PlanarArmOptions())
JOINTS = st.tuples(*(st.floats(joint.lower, joint.upper) for joint in ARM.joints))


def numbers(text: str) -> FloatArray:
    return np.array([float(word) for word in text.split()])


@given(JOINTS)
def test_forward_and_inverse_agree_within_limits(q: tuple[float, float, float]) -> None:
    found = ARM.inverse(ARM.forward(q), q)
    assert found is not None
    assert ARM.within_limits(found)
    np.testing.assert_allclose(ARM.forward(found), ARM.forward(q), atol=1e-9)


@given(JOINTS)
def test_the_urdf_moves_like_the_arm(q: tuple[float, float, float]) -> None:
    tree = UrdfTree(ARM.urdf())
    values = dict(zip([joint.name for joint in ARM.joints], q, strict=True))
    np.testing.assert_allclose(tree.pose_of(ARM.tip_link, values), ARM.forward(q), atol=1e-9)


@pytest.mark.parametrize("q", [[2.1, 0.0, 0.0], [0.0, -2.1, 0.0]], ids=["too far in", "too far south"])
def test_poses_beyond_the_limits_have_no_joints(q: list[float]) -> None:
    assert ARM.inverse(ARM.forward(q)) is None


def test_poses_out_of_the_plane_have_no_joints() -> None:
    assert ARM.inverse(planar_pose(0.1, 0.1, 0.02, 0.0)) is None
    tilted = np.array([0.1, 0.1, 0.0, math.cos(0.2), math.sin(0.2), 0.0, 0.0])
    assert ARM.inverse(tilted) is None


def test_bad_input_is_told() -> None:
    with pytest.raises(ArmError, match=r"three finite joint values \(x, y, yaw\), not \[0.0, 1.0\]"):
        ARM.forward([0.0, 1.0])
    with pytest.raises(ArmError, match="seven finite numbers"):
        ARM.inverse([0.0, 1.0])
    with pytest.raises(ArmError, match=r"opens from 0 to 0\.08 m, not to 0\.2 m"):
        ARM.shape.outlines(0.2)


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"link_width": 0.3, "finger_length": 0.02},
        {"link_width": 0.02, "insertion_width": 0.05, "max_opening": 0.1},
        {"link_length": 0.3, "palm_length": 0.2, "max_opening": 0.01},
    ],
    ids=["default", "wide link", "wide gripper", "short link"],
)
@pytest.mark.parametrize("shelf", [Shelf(0.594, 0.584), Shelf(0.3, 1.5, 0.2)], ids=["published", "flat and wide"])
def test_it_conforms_whatever_its_size_and_the_shelf(settings: dict[str, float], shelf: Shelf) -> None:
    check_arm(PlanarArm(PlanarArmOptions(**settings)), shelf)


def test_the_published_widths() -> None:
    shape = ARM.shape
    assert (shape.link_width, shape.insertion_width, shape.max_opening, shape.height) == (0.12, 0.018, 0.08, 0.06)
    assert [outline.part for outline in shape.closed] == ["left finger", "right finger", "palm", "link"]


def test_collision_boxes_are_the_outlines() -> None:
    tree, boxes = UrdfTree(ARM.urdf()), {}
    for link in tree.root.findall("link"):
        for shape in link.findall("collision"):
            origin, box = shape.find("origin"), shape.find("geometry/box")
            assert origin is not None
            assert box is not None
            name = shape.get("name", "").removesuffix(" collision")
            boxes[name] = numbers(origin.get("xyz", "")), numbers(box.get("size", ""))
    assert set(boxes) == {outline.part for outline in ARM.shape.closed}
    for outline in ARM.shape.closed:
        center, size = boxes[outline.part]
        lower, upper = outline.vertices.min(axis=0), outline.vertices.max(axis=0)
        np.testing.assert_allclose(
            [center[:2] - size[:2] / 2.0, center[:2] + size[:2] / 2.0], [lower, upper], atol=1e-12
        )


@pytest.mark.parametrize("given_options", [{"link_width": "-1"}, {"max_opening": "inf"}, {"width": "1"}])
def test_bad_options_are_told(given_options: dict[str, str]) -> None:
    with pytest.raises(OptionError, match="arm planar"):
        PlanarArmOptions.parse(given_options, "arm planar")
