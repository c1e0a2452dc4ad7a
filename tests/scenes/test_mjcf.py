"""What is exported for MuJoCo loads there and is the scene."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from phframe.core import BasePose, Cylinder, Scene, SceneObject, Shelf
from phframe.runtime.scenes import find_scene, scene_names
from phframe.scenes.mjcf import body_names, scene_to_mjcf

pytestmark = pytest.mark.needs_mujoco

PUBLISHED = [name for name in scene_names() if name.startswith(("vieira", "papallas"))]
ODD = Scene(
    'a <scene> & "more"',
    Shelf(0.6, 0.5, 0.3, board_friction=0.4, wall_friction=0.1),
    (
        SceneObject("world", Cylinder(0.04, 0.2), (0.2, 0.2), yaw=-2.0, mass=0.7, friction=0.3),
        SceneObject("board", Cylinder(0.03, 0.1), (0.4, 0.2)),
        SceneObject("object board", Cylinder(0.03, 0.1), (0.4, 0.3)),
        SceneObject("arm/<&>", Cylinder(0.02, 0.1), (0.5, 0.1), yaw=1.0),
    ),
    "board",
    {"planar": BasePose(-0.2, 0.25, 0.06, 0.5)},
)


def loaded(text: str) -> tuple[Any, Any]:
    """MuJoCo's model of a text, and its data with all poses computed."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


@pytest.mark.parametrize("scene", [ODD, find_scene("vieira/basic"), find_scene("random/3")], ids=lambda each: each.name)
def test_objects_have_their_pose_mass_and_size(scene: Scene) -> None:
    model, data = loaded(scene_to_mjcf(scene))
    poses = scene.initial_state().poses
    assert len({*body_names(scene)}) == len(scene.objects)
    for row, (name, item) in enumerate(zip(body_names(scene), scene.objects, strict=True)):
        body = model.body(name)
        np.testing.assert_allclose(data.xpos[body.id], poses[row, :3], atol=1e-12)
        np.testing.assert_allclose(data.xquat[body.id], poses[row, 3:], atol=1e-12)
        assert float(body.mass[0]) == item.mass
        geom = model.geom(int(body.geomadr[0]))
        assert geom.size[:2].tolist() == [item.shape.radius, item.shape.height / 2.0]
    assert model.njnt == len(scene.objects)


def test_the_target_is_named_and_has_a_colour_of_its_own() -> None:
    mujoco = pytest.importorskip("mujoco")
    model, _ = loaded(scene_to_mjcf(ODD))
    colours = {name: tuple(model.geom(name).rgba) for name in body_names(ODD)}
    target = body_names(ODD)[ODD.target_index]
    row = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_TEXT, "target")
    assert model.text_data[model.text_adr[row] :].split(b"\0")[0].decode() == target
    assert sum(colour == colours[target] for colour in colours.values()) == 1


def test_contacts_have_the_scenes_friction() -> None:
    mujoco = pytest.importorskip("mujoco")
    item = SceneObject("can", Cylinder(0.03, 0.04), (0.4, 0.03), friction=0.5)
    model, data = loaded(scene_to_mjcf(Scene("corner", Shelf(0.6, 0.5, wall_friction=0.3), (item,), "can")))
    model.opt.gravity = [0.0, -5.0, -9.81]
    for _ in range(10):
        mujoco.mj_step(model, data)
    found = {
        model.geom(int(geom)).name: float(contact.friction[0]) for contact in data.contact for geom in contact.geom
    }
    del found["can"]
    assert found == {"board": 0.5, "south wall": 0.3}


def test_on_a_slope_less_steep_than_its_friction_an_object_stays() -> None:
    mujoco = pytest.importorskip("mujoco")
    item = SceneObject("can", Cylinder(0.03, 0.04), (0.4, 0.25), friction=0.5)
    scene = Scene("slope", Shelf(2.0, 0.5, board_friction=0.2), (item,), "can")
    moved = []
    for fraction in (0.9, 1.1):
        model, data = loaded(scene_to_mjcf(scene))
        angle = math.atan(fraction * 0.5)
        model.opt.gravity = [9.81 * math.sin(angle), 0.0, -9.81 * math.cos(angle)]
        model.opt.impratio = 100.0
        for _ in range(500):
            mujoco.mj_step(model, data)
        moved.append(float(data.body("can").xpos[0]) - 0.4)
    assert moved[0] < 0.01
    assert moved[1] > 0.05


@pytest.mark.slow
def test_published_scenes_stay_at_rest() -> None:
    mujoco = pytest.importorskip("mujoco")
    for name in PUBLISHED:
        model, data = loaded(scene_to_mjcf(find_scene(name)))
        before = data.qpos.copy()
        for _ in range(1000):
            mujoco.mj_step(model, data)
        assert np.abs(data.qpos - before).max() < 1e-3, name


@pytest.mark.parametrize("name", ["planar", pytest.param("baxter", marks=pytest.mark.needs_baxter)])
def test_an_arm_stands_parked_at_its_base_pose_and_holds_still(name: str) -> None:
    mujoco = pytest.importorskip("mujoco")
    if name == "baxter":
        pytest.importorskip("pinocchio")
    from phframe.backends.mujoco_.arm import PREFIX
    from phframe.backends.mujoco_.export import HOME, with_arm
    from phframe.core import compose
    from phframe.registry import Kind, create

    scene, arm = find_scene("vieira/basic"), create(Kind.ARM, name)
    base_pose = arm.default_base_pose(scene.shelf)
    model, data = loaded(with_arm(scene_to_mjcf(scene), arm, base_pose))
    mujoco.mj_resetDataKeyframe(model, data, model.key(HOME).id)
    mujoco.mj_kinematics(model, data)
    tip = data.body(PREFIX + arm.tip_link)
    np.testing.assert_allclose(tip.xpos, compose(base_pose.pose, arm.forward(arm.home))[:3], atol=1e-5)
    before = data.qpos.copy()
    for _ in range(500):
        mujoco.mj_step(model, data)
    assert np.abs(data.qpos - before).max() < 1e-3
    assert model.nu == len(arm.joints) + 2
