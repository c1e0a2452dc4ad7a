"""Scenes written are the scenes read; a file appears whole or not at all."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import BasePose, Cylinder, InputError, Scene, SceneObject, Shelf
from phframe.scenes import RandomScenes, parse_scene, read_scene, scene_to_yaml, write_scene

SCENE = RandomScenes().load("3")

figure = st.floats(-100.0, 100.0)
size = st.floats(1e-3, 1e3)
friction = st.floats(0.0, 10.0)
name = st.text(min_size=1, max_size=100).filter(lambda text: text.isprintable() and text == text.strip())
base_pose = st.builds(BasePose, figure, figure, figure, figure)


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """Scenes of up to four objects, each in its own place of a row along the shelf."""
    ids = draw(st.lists(name, min_size=1, max_size=4, unique=True))
    radius = draw(st.floats(0.001, 0.1))
    height = draw(st.floats(0.001, 1.0))
    items = tuple(
        SceneObject(
            each,
            Cylinder(radius, height),
            (draw(st.floats(0.0, 0.5)), 0.2 + 0.3 * index),
            draw(st.just(0.0) | figure),
            draw(st.just(0.3) | size),
            draw(st.none() | friction),
        )
        for index, each in enumerate(ids)
    )
    shelf = Shelf(draw(st.floats(0.7, 5.0)), 2.0, 1.0, draw(friction), draw(friction))
    base_poses = draw(st.dictionaries(name, base_pose, max_size=2))
    return Scene(draw(name), shelf, items, draw(st.sampled_from(ids)), base_poses)


@given(scenes())
@settings(max_examples=40, deadline=None)
def test_a_scene_written_and_read_is_the_same_scene(scene: Scene) -> None:
    text = scene_to_yaml(scene)
    again = parse_scene(text)
    assert again == scene
    assert again.base_poses == scene.base_poses
    assert scene_to_yaml(again) == text


def test_the_text_is_the_published_format() -> None:
    item = SceneObject("object_1", Cylinder(0.03, 0.12), (0.37975, 0.31175))
    other = SceneObject("true", Cylinder(0.03, 0.12), (0.5, 0.1), mass=1.0)
    scene = Scene("s01", Shelf(0.594, 0.584), (item, other), "true", {"planar": BasePose(-0.5, 0.25, 0.0, math.pi)})
    assert scene_to_yaml(scene) == (
        "phframe: 1\n"
        "name: s01\n"
        "shelf: {depth: 0.594, width: 0.584, height: 0.4}\n"
        "mount: {planar: [-0.5, 0.25, 0.0, 3.141592653589793]}\n"
        'target: "true"\n'
        "objects:\n"
        "  - {id: object_1, shape: cylinder, radius: 0.03, height: 0.12, position: [0.37975, 0.31175]}\n"
        '  - {id: "true", shape: cylinder, radius: 0.03, height: 0.12, position: [0.5, 0.1], mass: 1.0}\n'
    )


def test_figures_of_numpy_are_written_as_plain_numbers() -> None:
    x, y = np.array([0.25, 0.3])
    scene = Scene("n", Shelf(np.float64(0.6), 0.6), (SceneObject("a", Cylinder(np.float64(0.03)), (x, y)),), "a")
    assert parse_scene(scene_to_yaml(scene)) == scene


def test_a_file_is_written_and_replaced(tmp_path: Path) -> None:
    path = tmp_path / "scene.yaml"
    path.write_text("something else that is longer than the scene " * 100)
    write_scene(SCENE, path)
    assert read_scene(path) == SCENE
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "link.yaml").symlink_to(tmp_path / "scene.yaml")
    write_scene(SCENE, tmp_path / "link.yaml")
    assert (tmp_path / "link.yaml").is_symlink()
    assert read_scene(tmp_path / "scene.yaml") == SCENE


def test_a_path_that_cannot_be_written_is_one_clear_line_and_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    before = sorted(tmp_path.iterdir())
    for path in ("folder", "file/a.yaml", "x" * 300, "a\0b"):
        with pytest.raises(InputError, match=r"cannot write|is not a path") as caught:
            write_scene(SCENE, tmp_path / path)
        assert str(caught.value).isprintable()
    assert sorted(tmp_path.iterdir()) == before
    assert not list((tmp_path / "folder").iterdir())
