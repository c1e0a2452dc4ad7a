"""Every scene that is listed is the same for ever: its file, byte for byte."""

from __future__ import annotations

from hashlib import sha256
from typing import Any

import pytest

from phframe.core import SceneSuite
from phframe.scenes import DenseScenes, NearScenes, Paper, RandomScenes, scene_to_yaml

DIGESTS: dict[type[SceneSuite[Any]], str] = {
    DenseScenes: "0c5720bc17752676e2bd69d2c0394d683b24ce9998ddcd968abf2d952f07e3f8",
    NearScenes: "b542e3bf827dc1fbdd067d1176552c6349aaeffdff71394bea36ee8804abda3a",
    Paper: "14706263b254e90915640c4f63393c7e7f8e63faec018146ae9ea7d8474564f6",
    RandomScenes: "e407da1c5068479882d875ffa4dbc5f3228a5de95961a0a1184b9e56692591c1",
}


@pytest.mark.parametrize("suite", DIGESTS)
def test_the_scenes_listed_are_the_same_for_ever(suite: type[SceneSuite[Any]]) -> None:
    made = suite(suite.options_type())
    text = "".join(scene_to_yaml(made.load(name)) for name in made.names())
    assert sha256(text.encode()).hexdigest() == DIGESTS[suite]
