"""Paths put together keep the rule of every leg, and the way back is as long as it must be."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phframe.core import Contacts, Phase, PhaseRule, controlled_path, rotation_matrix, time_path
from phframe.kinodynamic.paths import at_rest, joined, straight_back, way_out
from tests.pushing.parts import ARM

RULE = PhaseRule(0.1, 0.0, Contacts.OBJECTS)
TWISTS = np.array([[0.1, 0.0, 0.05], [0.03, -0.04, 0.0], [0.0, 0.0, 0.1]])


def test_joined_paths_take_as_long_as_one_after_another() -> None:
    first = controlled_path([0.0, 0.3, 0.0], TWISTS, 1.0, Phase.INSERT, RULE)
    second = controlled_path(first.poses[-1], -TWISTS, 2.0, Phase.SWEEP, RULE)
    third = straight_back(second.poses[-1], 0.15, Phase.RETREAT, RULE)
    whole = joined([first, second, third])
    assert whole.phases == first.phases + second.phases + third.phases
    np.testing.assert_array_equal(whole.poses, np.vstack([first.poses, second.poses[1:], third.poses[1:]]))
    parts = [time_path(each, 0.0, 60.0).duration for each in (first, second, third)]
    assert time_path(whole, 0.0, 60.0).duration == pytest.approx(sum(parts))
    assert parts == pytest.approx([3.0, 6.0, 1.5])


def test_joined_paths_handle_what_they_are_told_to() -> None:
    pose = np.array([0.2, 0.3, 0.0])
    grip = PhaseRule(0.1, 0.05, Contacts.MANIPULAND)
    whole = joined([at_rest(pose, Phase.GRASP, grip), straight_back(pose, 0.3, Phase.WITHDRAW, RULE)], "target")
    assert whole.manipuland == "target"
    assert [whole.rule(leg).opening for leg in range(2)] == [0.05, 0.0]


@pytest.mark.parametrize("yaw", [0.0, 0.5, -0.7])
def test_the_way_out_brings_all_of_the_arm_before_the_mouth(yaw: float) -> None:
    pose = np.array([0.35, 0.3, yaw])
    path = straight_back(pose, way_out(pose, ARM), Phase.RETREAT, RULE)
    corners = np.vstack([part.vertices for part in ARM.closed]) @ rotation_matrix(yaw).T + path.poses[-1, :2]
    assert corners[:, 0].max() == pytest.approx(-0.05)
    assert math.isclose(path.poses[-1, 2], yaw)


def test_an_arm_that_is_out_has_no_way_out() -> None:
    assert way_out(np.array([-0.2, 0.3, 0.1]), ARM) == 0.0
