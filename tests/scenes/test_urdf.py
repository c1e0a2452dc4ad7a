"""What is exported as URDF loads in other programs and is the scene."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from phframe.core import Scene, UnknownShapeError
from phframe.runtime.scenes import find_scene
from phframe.scenes.urdf import FOLDER, LIST_FILE, SHELF_FILE, object_links, position_of, scene_parts, scene_to_urdf
from tests import prism
from tests.scenes.test_mjcf import ODD

SCENES = [ODD, find_scene("papallas/s02")]
each_scene = pytest.mark.parametrize("scene", SCENES, ids=lambda each: each.name)


@each_scene
def test_links_are_named_apart_and_listed_with_their_poses(scene: Scene) -> None:
    parts = scene_parts(scene)
    listed = json.loads(parts[LIST_FILE])
    assert listed["shelf"] == SHELF_FILE
    assert [each["id"] for each in listed["objects"]] == list(scene.ids)
    assert [each["id"] for each in listed["objects"] if each["target"]] == [scene.target]
    assert {each["urdf"] for each in listed["objects"]} == {path for path in parts if path.startswith(FOLDER)}
    for row, each in enumerate(listed["objects"]):
        x, y, z, w, *vector = scene.initial_state().poses[row]
        np.testing.assert_allclose([*each["position"], *each["orientation"]], [x, y, z, *vector, w], atol=1e-12)
    assert len({name.lower() for name in object_links(scene)}) == len(scene.objects)


@each_scene
@pytest.mark.needs_baxter
def test_pinocchio_sees_every_body_where_it_is(scene: Scene) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio.buildModelFromXML(scene_to_urdf(scene))
    assert model.nq == 0
    assert float(model.inertias[0].mass) == pytest.approx(sum(item.mass for item in scene.objects))
    for link, item in zip(object_links(scene), scene.objects, strict=True):
        placement = model.frames[model.getFrameId(link)].placement
        np.testing.assert_allclose(placement.translation, position_of(item), atol=1e-12)
        assert np.arctan2(placement.rotation[1, 0], placement.rotation[0, 0]) == pytest.approx(item.yaw)


@pytest.mark.needs_baxter
@each_scene
def test_pinocchio_finds_the_shapes_and_no_collision_between_them(scene: Scene) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    text = scene_to_urdf(scene)
    model = pinocchio.buildModelFromXML(text)
    shapes = pinocchio.buildGeomFromUrdfString(model, text, pinocchio.GeometryType.COLLISION)
    assert len(shapes.geometryObjects) == 5 + len(scene.objects)
    radii = [shape.geometry.radius for shape in shapes.geometryObjects if hasattr(shape.geometry, "radius")]
    assert sorted(radii) == pytest.approx(sorted(item.radius for item in scene.objects))


@pytest.mark.needs_pybullet
def test_the_parts_come_to_rest_in_pybullet_where_they_were_put(tmp_path: Path) -> None:
    bullet = pytest.importorskip("pybullet")
    scene = find_scene("vieira/basic")
    for path, text in scene_parts(scene).items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    listed = json.loads((tmp_path / LIST_FILE).read_text())
    client = bullet.connect(bullet.DIRECT)
    try:
        bullet.setGravity(0.0, 0.0, -9.81, physicsClientId=client)
        bullet.loadURDF(str(tmp_path / listed["shelf"]), useFixedBase=True, physicsClientId=client)
        bodies = [
            bullet.loadURDF(str(tmp_path / each["urdf"]), each["position"], each["orientation"], physicsClientId=client)
            for each in listed["objects"]
        ]
        for body, item in zip(bodies, scene.objects, strict=True):
            mass, friction, *_ = bullet.getDynamicsInfo(body, -1, physicsClientId=client)
            assert mass == pytest.approx(item.mass)
            assert friction == pytest.approx(scene.shelf.board_friction)
        for _ in range(240):
            bullet.stepSimulation(physicsClientId=client)
        for body, item in zip(bodies, scene.objects, strict=True):
            position, _ = bullet.getBasePositionAndOrientation(body, physicsClientId=client)
            np.testing.assert_allclose(position, position_of(item), atol=2e-3)
    finally:
        bullet.disconnect(client)


def test_the_target_has_a_colour_of_its_own() -> None:
    robot = ET.fromstring(scene_to_urdf(ODD))
    colours = {
        str(link.get("name")): str(color.get("rgba"))
        for link in robot.iter("link")
        for color in link.iterfind("visual/material/color")
    }
    target = colours[object_links(ODD)[ODD.target_index]]
    assert list(colours.values()).count(target) == 1


def test_a_shape_that_is_not_known_is_refused() -> None:
    for export in (scene_to_urdf, scene_parts):
        with pytest.raises(UnknownShapeError, match="the export to URDF has no primitive for the shape 'prism'"):
            export(prism.SCENE)
