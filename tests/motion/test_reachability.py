"""The reach of an arm: what a base pose is worth, counted over the shelf."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from io import BytesIO
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import ArmModel, BasePose, Cylinder, Scene, SceneObject, Shelf, compose, inverse, planar_pose
from phframe.motion.reachability import INSET, MOST_POSITIONS, reachability
from phframe.motion.straight_way import YAWS
from phframe.registry import Kind, create
from tests.prism import PRISM

SHELF = Shelf(0.594, 0.584)
SCENE = Scene("alone", SHELF, (SceneObject("can", Cylinder(0.03), (0.4, 0.3)),), "can")


def fraction(arm: ArmModel[Any], base_pose: BasePose, shelf: Shelf = SHELF) -> float:
    return reachability(shelf, arm, base_pose).fraction


def test_a_planar_arm_reaches_all_that_its_link_fits_into() -> None:
    arm = PlanarArm(PlanarArmOptions())
    reach = reachability(SHELF, arm, arm.default_base_pose(SHELF))
    assert reach.depths[0] >= INSET
    assert reach.widths[-1] <= SHELF.width - INSET
    beside_wall = reach.widths < arm.shape.link_width / 2.0
    deep = reach.depths > 0.15
    assert np.isinf(reach.yaws[np.ix_(beside_wall, deep)]).sum() == 0, "a few degrees of yaw get it there"
    assert (np.abs(reach.yaws[np.ix_(beside_wall, deep)]) > 0.0).all()
    middle = np.abs(reach.widths - SHELF.width / 2.0) < 0.2
    assert (reach.yaws[middle] == 0.0).all()


def test_of_a_wide_arm_less_is_within_reach() -> None:
    wide = PlanarArm(PlanarArmOptions(link_width=0.5))
    assert 0.1 < fraction(wide, wide.default_base_pose(SHELF)) < 0.6


def test_the_map_of_a_large_shelf_is_coarser_but_no_larger() -> None:
    arm, hall = PlanarArm(PlanarArmOptions()), Shelf(10.0, 0.3)
    reach = reachability(hall, arm, arm.default_base_pose(hall))
    assert reach.yaws.shape == (5, MOST_POSITIONS)
    assert (reach.depths[0], reach.depths[-1]) == pytest.approx((INSET, 10.0 - INSET))


def test_a_mount_out_of_reach_is_worth_nothing() -> None:
    arm = PlanarArm(PlanarArmOptions())
    assert fraction(arm, BasePose(-3.0, 0.29, arm.shape.height, 0.0)) == 0.0
    assert fraction(arm, BasePose(-0.1, 0.29, 0.2, 0.0)) == 0.0, "the planar arm stays in its plane"


def test_the_yaws_tried_are_level_ones_within_forty_degrees() -> None:
    assert YAWS[0] == 0.0
    assert max(map(abs, YAWS)) == pytest.approx(math.radians(40))


@pytest.mark.slow
@pytest.mark.needs_baxter
def test_baxter_reaches_its_shelf_and_less_from_farther_away() -> None:
    pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")
    from tests.arms.baxter_arm import baxter

    arm = baxter("left")
    base_pose = arm.default_base_pose(SHELF)
    assert fraction(arm, base_pose) > 0.95
    assert fraction(arm, BasePose(base_pose.x - 0.2, base_pose.y, base_pose.z, 0.0)) < 0.8
    assert fraction(arm, BasePose(base_pose.x - 1.0, base_pose.y, base_pose.z, 0.0)) == 0.0


@pytest.mark.needs_baxter
@pytest.mark.parametrize("away", [0.0, 0.1, 0.3, 1.0])
def test_what_is_refused_is_what_arm_reach_says(away: float, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")
    from phframe.cli.reaching import run
    from phframe.core.arm import LEAST_SERVED
    from phframe.runtime.scenes import find_scene

    arm, shelf = create(Kind.ARM, "baxter"), find_scene("papallas/s02").shelf
    own = arm.default_base_pose(shelf)
    base_pose = own.x - away, own.y, own.z, own.yaw
    run("baxter", "papallas/s02", base_pose, None, {"arm": {}, "scenes": {}}, as_json=True, force=False)
    served = arm.fraction_served(shelf, BasePose(*base_pose))
    assert json.loads(capsys.readouterr().out)["fraction"] == served
    assert (served >= LEAST_SERVED) == (away < 0.2)


@pytest.mark.slow
@pytest.mark.needs_baxter
def test_what_spreads_from_cell_to_cell_is_what_a_search_everywhere_finds() -> None:
    pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")
    from tests.arms.baxter_arm import baxter

    arm = baxter("left")
    own = arm.default_base_pose(SHELF)
    base_pose = BasePose(own.x - 0.15, own.y, own.z, own.yaw)
    reach = reachability(SHELF, arm, base_pose)
    middle = len(reach.widths) // 2
    for column, x in enumerate(reach.depths.tolist()):
        pose = compose(inverse(base_pose.pose), planar_pose(x, float(reach.widths[middle]), arm.shape.height, 0.0))
        assert (arm.inverse(pose) is not None) == (reach.yaws[middle, column] == 0.0), f"at x = {x}"


def test_an_arm_that_does_not_know_leaves_it_to_be_found_out() -> None:
    arm = PlanarArm(PlanarArmOptions())
    assert arm.fraction_served(SHELF, arm.default_base_pose(SHELF)) is None
    assert fraction(arm, arm.default_base_pose(SHELF)) == 1.0


def picture_of(scene: Scene) -> bytes:
    pytest.importorskip("matplotlib")
    from phframe.cli.reach_map import reach_picture

    arm = PlanarArm(PlanarArmOptions(link_width=0.5))
    return reach_picture(reachability(SHELF, arm, arm.default_base_pose(SHELF)), scene, "planar")


def test_the_map_shows_objects_by_their_outlines() -> None:
    prism = replace(SCENE.objects[0], shape=PRISM)
    around = replace(prism, shape=Cylinder(PRISM.bounding_radius))
    turned = replace(prism, yaw=0.5)
    assert len({picture_of(replace(SCENE, objects=(item,))) for item in (prism, around, turned)}) == 3


def test_the_map_is_a_picture() -> None:
    content = picture_of(SCENE)
    from matplotlib.image import imread

    picture = imread(BytesIO(content))
    assert picture.shape[0] > 400
    assert float(picture[..., :3].std()) > 0.05
