"""What the README says of Baxter's reach: targets that no grasp can get at, whatever stands before them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phframe.registry import Kind, create
from phframe.runtime.scenes import find_scene

pytest.importorskip("pinocchio")
pytestmark = [pytest.mark.needs_baxter, pytest.mark.slow]

YAWS = [math.radians(degrees) for degrees in range(-60, 61, 10)]


@pytest.mark.parametrize(("name", "reached"), [("s01", False), ("s05", False), ("s08", False), ("s02", True)])
def test_targets_far_in_are_out_of_reach_at_every_yaw_from_the_default_base_pose(name: str, reached: bool) -> None:
    arm, scene = create(Kind.ARM, "baxter"), find_scene(f"papallas/{name}")
    base_pose = arm.default_base_pose(scene.shelf)
    x, y = scene.objects[scene.target_index].position
    poses = [arm.fingertip_pose(np.array([x, y, yaw]), base_pose) for yaw in YAWS]
    assert any(arm.inverse(pose) is not None for pose in poses) is reached
