"""Scene files in which anything is wrong: a scene that all of phframe takes, or one line that says what is wrong where."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from pydantic import TypeAdapter

from phframe.backends.pymunk_.physics import PymunkPhysics
from phframe.core import PhframeError, Scene
from phframe.runtime.mounting import arm_in
from phframe.runtime.scenes import find_scene
from phframe.scenes import parse_scene, scene_to_yaml
from phframe.scenes.mjcf import scene_to_mjcf
from phframe.scenes.urdf import scene_to_urdf
from phframe.scenes.writer import scene_content
from tests.faults.files.spoiling import TEXTS, a_line, spoilt, spoilt_text
from tests.faults.files.yaml_text import YAML, as_yaml
from tests.trials import many, tried

CORPUS = Path(__file__).parent / "corpus" / "scenes"
SCENE = find_scene("vieira/simple-10")
CONTENT = {**scene_content(SCENE), "mount": {"planar": [-0.5, 0.3, 0.0, 0.1]}}
STORED = TypeAdapter(Scene)
PIECES = (*TEXTS, *YAML)
PLACE = re.compile(
    r"line \d+|objects? ['\"]|it has \d+ objects|larger than|the (file|id|target|name|arm) |shelf |base pose of"
)
"""What a problem must name."""


def judged(text: str) -> Scene | str:
    """The scene in a text, which all of phframe must then take; or what is wrong with it, a line."""
    try:
        scene = parse_scene(text, "spoilt.yaml")
    except PhframeError as error:
        told = a_line(error)
        assert told.startswith("spoilt.yaml: ")
        assert told.isprintable()
        assert PLACE.search(told), told
        return told
    _is_one(scene)
    return scene


def _is_one(scene: Scene) -> None:
    start = scene.initial_state()
    assert np.isfinite(start.poses).all()
    assert parse_scene(scene_to_yaml(scene)) == scene
    assert STORED.validate_python(json.loads(STORED.dump_json(scene))) == scene
    assert 0.0 < scene.coverage < 1.1
    for text in (scene_to_mjcf(scene), scene_to_urdf(scene)):
        ET.fromstring(text.encode())
    physics = PymunkPhysics(scene, *arm_in(scene, "planar", {}), PymunkPhysics.options_type())
    try:
        held = physics.restore(start)
        assert np.isfinite(held.poses).all()
        assert (held.displacement(start) < 0.05).all()
    finally:
        physics.close()


@settings(max_examples=many(60), deadline=None)
@given(spoilt(CONTENT))
def test_whatever_a_scene_file_says_it_is_a_scene_or_one_line(content: Any) -> None:
    tried("inputs: scene files that say something else")
    judged(as_yaml(content))


@settings(max_examples=many(60), deadline=None)
@given(spoilt_text(scene_to_yaml(SCENE), PIECES))
def test_whatever_is_written_in_a_scene_file_it_is_a_scene_or_one_line(text: str) -> None:
    tried("inputs: scene files with a word or line changed")
    judged(text)


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*.yaml")), ids=lambda path: path.stem)
def test_scene_files_that_went_wrong_once_are_one_line(path: Path) -> None:
    assert isinstance(judged(path.read_text(encoding="utf-8")), str)
