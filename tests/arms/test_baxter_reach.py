"""Baxter's reach: which published targets it gets at in an empty shelf, and from where its base would have to stand."""

from __future__ import annotations

import gc
import math
import weakref

import numpy as np
import pytest

from phframe.core import BasePose, OptionError, Scene, State, Unreachable
from phframe.registry import Kind, create
from phframe.runtime.scenes import find_scene

pytest.importorskip("pinocchio")
pytestmark = pytest.mark.needs_baxter

from phframe.arms.baxter import Baxter, BaxterOptions  # noqa: E402
from phframe.arms.baxter.model import Side  # noqa: E402
from phframe.motion.cartesian_path import JointPath  # noqa: E402
from phframe.motion.mount_map import best_mount, mount_map  # noqa: E402
from phframe.motion.straight_reach import StraightReach  # noqa: E402

PUBLISHED = [
    *(f"papallas/s{number:02d}" for number in range(1, 11)),
    "vieira/basic",
    *(f"vieira/{kind}-{number:02d}" for kind in ("simple", "example") for number in range(1, 11)),
]
BEFORE_MOUTH, BESIDE_MIDDLE, BELOW_BOARD = 0.675, 0.35, 0.15
"""Of the base, where the arms stood first (m)."""


def standing(scene: Scene, side: Side, across: float = 0.0, up: float = 0.0) -> tuple[Baxter, BasePose]:
    sign = -1.0 if side == "left" else 1.0
    y = scene.shelf.width / 2.0 + sign * BESIDE_MIDDLE + across
    return Baxter(BaxterOptions(side=side)), BasePose(-BEFORE_MOUTH, y, -BELOW_BOARD + up, 0.0)


def reach(scene: Scene, side: Side, across: float = 0.0, up: float = 0.0) -> StraightReach:
    arm, base_pose = standing(scene, side, across, up)
    return arm.straight_reach(scene.shelf, base_pose)


def degrees(scene: Scene, side: Side, across: float = 0.0, up: float = 0.0) -> set[int]:
    item = scene.objects[scene.target_index]
    yaws = reach(scene, side, across, up).grasp_yaws(item.position, item.radius, 3)
    return {round(math.degrees(yaw)) for yaw in yaws}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["s01", "s05", "s08"])
def test_three_targets_are_out_of_the_left_arms_reach_at_every_yaw(name: str) -> None:
    scene = find_scene(f"papallas/{name}")
    arm, base_pose = standing(scene, "left")
    assert degrees(scene, "left") == set()
    beyond = arm.out_of_reach(scene, scene.initial_state(), base_pose, scene.target)
    assert isinstance(beyond, Unreachable)
    assert "left_" in beyond.why or "out of reach" in beyond.why or "wall" in beyond.why


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "across", "up"), [("s05", 0.1, 0.0), ("s08", 0.1, 0.0), ("s01", 0.0, -0.1), ("s01", 0.0, -0.2)]
)
def test_they_are_reached_by_the_right_arm_from_elsewhere(name: str, across: float, up: float) -> None:
    scene = find_scene(f"papallas/{name}")
    assert degrees(scene, "right", across, up) != set()
    arm, base_pose = standing(scene, "right", across, up)
    assert arm.out_of_reach(scene, scene.initial_state(), base_pose, scene.target) is None


@pytest.mark.slow
def test_the_right_arm_reaches_all_published_targets_from_a_lower_base() -> None:
    missed = [name for name in PUBLISHED if not degrees(find_scene(name), "right", up=-0.1)]
    assert missed == []


@pytest.mark.slow
def test_from_its_default_base_baxter_gets_at_all_published_targets_and_out_again() -> None:
    arm = create(Kind.ARM, "baxter")
    missed = []
    for scene in map(find_scene, PUBLISHED):
        item = scene.objects[scene.target_index]
        reach = arm.straight_reach(scene.shelf, arm.default_base_pose(scene.shelf))
        if not reach.grasp_yaws(item.position, item.radius, 1, back=True):
            missed.append(scene.name)
    assert missed == []


@pytest.mark.slow
def test_a_way_ends_at_its_place_and_goes_on_without_a_jump() -> None:
    scene = find_scene("papallas/s02")
    arm, base_pose = standing(scene, "right", up=-0.1)
    way = arm.straight_reach(scene.shelf, base_pose).way((0.45, 0.3), 0.0, arm.shape.min_opening, 1)
    assert isinstance(way, JointPath)
    np.testing.assert_allclose(arm.gripper_pose(way.joints[-1], base_pose), [0.45, 0.3, 0.0], atol=1e-5)
    assert float(np.abs(np.diff(way.joints, axis=0)).max()) < 0.2
    assert float(way.poses[0, 0]) < 0.0


def test_a_reach_that_is_done_with_gives_its_memory_back_at_once() -> None:
    """A map makes dozens, each with the collision geometry of a whole robot, which nobody collects in time."""
    scene = find_scene("papallas/s02")
    arm, base_pose = standing(scene, "right")
    made = arm.straight_reach(scene.shelf, base_pose)
    made.grasp((0.2, 0.3), 0.03, 0.0)
    watched = weakref.ref(made)
    gc.disable()
    try:
        del made
        assert watched() is None
    finally:
        gc.enable()


def test_nothing_is_reached_beside_a_wall_from_far_away() -> None:
    scene = find_scene("papallas/s02")
    arm, base_pose = standing(scene, "left")
    far = BasePose(base_pose.x - 1.0, base_pose.y, base_pose.z, 0.0)
    assert arm.straight_reach(scene.shelf, far).depth(0.03, arm.shape.min_opening, 0.5) < 0.03


def test_a_mount_of_figures_counts_before_all_else() -> None:
    arm = create(Kind.ARM, "baxter", {"mount": "[-0.7,0.6,-0.2,0.1]"})
    assert arm.mount == BasePose(-0.7, 0.6, -0.2, 0.1)
    assert arm.mounted(find_scene("vieira/basic")) is arm, "there is nothing to choose"
    assert create(Kind.ARM, "baxter", {"mount": [-0.7, 0.6, -0.2, 0.1]}).options == arm.options
    assert create(Kind.ARM, "baxter").mount is None


@pytest.mark.parametrize("text", ["here", "[1,2,3]", "[1,2,3,nan]", "1,2,3,4,5"])
def test_a_mount_that_is_none_is_told(text: str) -> None:
    with pytest.raises(OptionError, match="option 'mount' is"):
        create(Kind.ARM, "baxter", {"mount": text})


@pytest.mark.slow
def test_auto_stands_where_the_target_is_reached_every_time_the_same() -> None:
    scene = find_scene("papallas/s01")
    told: list[tuple[int, int]] = []
    arm = create(Kind.ARM, "baxter", {"mount": "auto"}).mounted(scene, lambda done, of: told.append((done, of)))
    again = create(Kind.ARM, "baxter", {"mount": "auto"}).mounted(scene)
    assert arm.options == again.options
    assert arm.mount is not None
    assert [done for done, _ in told] == list(range(1, len(told) + 1))
    assert 1 < len(told) < told[0][1], "not at the default, and no farther than it must"
    item = scene.objects[scene.target_index]
    assert arm.straight_reach(scene.shelf, arm.mount).grasp_yaws(item.position, item.radius, 1, back=True) != ()
    assert arm.fraction_served(scene.shelf, arm.mount) > 0.9


def test_of_a_map_without_any_yaw_nothing_is_best() -> None:
    scene = find_scene("papallas/s01")
    arm, _ = standing(scene, "left")
    assert best_mount([], scene, 0.7) is None
    found = list(mount_map([arm], scene))
    assert len({(mount.base_pose.y, mount.base_pose.z) for mount in found}) == len(found)
    assert all(mount.base_pose.x == arm.default_base_pose(scene.shelf).x for mount in found)


def test_auto_stays_where_the_default_reaches_the_target() -> None:
    scene = find_scene("papallas/s06")
    arm = create(Kind.ARM, "baxter", {"mount": "auto"}).mounted(scene)
    assert arm.mount == create(Kind.ARM, "baxter").default_base_pose(scene.shelf)
    assert arm.options.side == create(Kind.ARM, "baxter").options.side


def test_an_object_that_has_been_pushed_is_looked_for_where_it_is() -> None:
    scene = find_scene("papallas/s02")
    arm, base_pose = standing(scene, "left")
    start, row = scene.initial_state(), scene.target_index
    assert arm.out_of_reach(scene, start, base_pose, scene.target) is None
    poses = start.poses.copy()
    poses[row, 1] = scene.shelf.width + 0.4
    beyond = arm.out_of_reach(scene, State(poses, start.conditions), base_pose, scene.target)
    assert beyond is not None
    assert "wall" in beyond.why
