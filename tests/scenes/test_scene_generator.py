"""Random scenes: the same for ever, like the published examples, and never an endless search."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import Scene, SceneError, UnknownNameError
from phframe.pushing import Corridor
from phframe.scenes import RandomOptions, RandomScenes, scene_to_yaml
from phframe.scenes.draws import Draws

HALF_WIDTH = 0.12


def corridor_to(scene: Scene) -> Corridor:
    """The corridor of Algorithm 1, built with angles: a second way to what the generator does without them."""
    (x, y), width = scene.objects[scene.target_index].position, scene.shelf.width
    north, south = y > width - HALF_WIDTH, y < HALF_WIDTH
    if not (north or south):
        return Corridor(np.zeros(2), 0.0, y, HALF_WIDTH, 0.0, x)
    sign, corner, height = (1.0, 0.0, y) if north else (-1.0, width, width - y)
    reach = math.hypot(x, height)
    angle = math.atan2(height, x) - math.asin(HALF_WIDTH / reach)
    along = math.sqrt(reach**2 - HALF_WIDTH**2)
    return Corridor(np.array([0.0, corner]), sign * angle, sign * HALF_WIDTH, HALF_WIDTH, 0.0, along)


def test_the_same_seed_gives_the_same_scene_for_ever() -> None:
    assert [item.position for item in RandomScenes().load("7").objects] == [
        *((0.1577, 0.184), (0.1377, 0.275), (0.2413, 0.3342), (0.2901, 0.572), (0.1213, 0.1194)),
        *((0.2861, 0.0559), (0.0468, 0.3131), (0.2254, 0.5328), (0.2381, 0.1671), (0.4469, 0.5219)),
    ]
    small = RandomOptions(count=3, blocking=3, radius=0.025, depth=0.4, width=0.5)
    assert [item.position for item in RandomScenes(small).load("1").objects] == [
        *((0.1166, 0.2158), (0.2435, 0.267), (0.1217, 0.3787), (0.3144, 0.451)),
    ]


def test_the_draws_are_the_same_for_ever() -> None:
    draws = Draws(2022)
    assert [draws.between(0, 9999) for _ in range(8)] == [2474, 929, 6117, 606, 6610, 7551, 1108, 430]


def test_another_process_gives_the_same_scene() -> None:
    code = "from phframe.scenes import *; print(scene_to_yaml(RandomScenes().load('11')), end='')"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == scene_to_yaml(RandomScenes().load("11"))


@given(st.integers(0, 10**18 - 1))
@settings(max_examples=100, deadline=None)
def test_every_seed_gives_a_scene_like_the_published_examples(seed: int) -> None:
    scene = RandomScenes().load(str(seed))
    assert scene.name == f"random/{seed}"
    *obstacles, target = scene.objects
    assert (len(obstacles), target.id, scene.target) == (9, "target", "target")
    assert 0.66 * scene.shelf.depth < target.position[0] <= 0.9 * scene.shelf.depth
    assert all(item.position[0] < target.position[0] for item in obstacles)
    inside = corridor_to(scene).contains(scene.initial_state().poses[:, :2])
    assert inside[:-1].sum() >= 2
    assert all(math.dist(item.position, target.position) >= 0.08 - 1e-9 for item in obstacles)
    for item in scene.objects:
        assert min(item.position[1], scene.shelf.width - item.position[1]) >= 0.032 - 1e-9
        assert item.position == tuple(round(v, 4) for v in item.position)


def test_seeds_give_different_scenes_straight_and_angled() -> None:
    corridors = [corridor_to(RandomScenes().load(str(seed))) for seed in range(40)]
    assert len({corridor.end for corridor in corridors}) > 30
    assert {(corridor.angle > 0) - (corridor.angle < 0) for corridor in corridors} == {-1, 0, 1}


def test_size_count_and_shelf_can_be_set() -> None:
    options = RandomOptions(
        count=20, depth=0.8, width=0.9, height=0.3, radius=0.02504, object_height=0.2, gap=0.01, blocking=6
    )
    scene = RandomScenes(options).load("5")
    assert len(scene.objects) == 21
    assert (scene.shelf.depth, scene.shelf.width, scene.shelf.height) == (0.8, 0.9, 0.3)
    assert {(item.radius, item.shape.height) for item in scene.objects} == {(0.02504, 0.2)}
    gaps = [
        math.dist(a.position, b.position) - 2 * 0.02504 for i, a in enumerate(scene.objects) for b in scene.objects[:i]
    ]
    assert min(gaps) >= 0.01
    assert corridor_to(scene).contains(scene.initial_state().poses[:-1, :2]).sum() >= 6


def test_one_obstacle_is_in_the_way() -> None:
    for seed in range(200):
        scene = RandomScenes(RandomOptions(count=1)).load(str(seed))
        assert corridor_to(scene).contains(scene.initial_state().poses[:1, :2]).all()


@pytest.mark.parametrize(
    "settings_",
    [
        *({"count": 200}, {"radius": 1.0}, {"width": 0.05}, {"depth": 0.1}, {"corridor": 1.0}, {"target_gap": 1.0}),
        *({"gap": 1.0}, {"count": 60, "blocking": 60}),
    ],
    ids=str,
)
def test_what_cannot_be_ends_in_a_clear_error(settings_: dict[str, float]) -> None:
    with pytest.raises(SceneError, match=r"random/3: no place for \d+ obstacles of radius .* lower count, radius"):
        RandomScenes(RandomOptions.parse(settings_, "scenes random")).load("3")


def test_objects_taller_than_the_shelf_are_refused() -> None:
    with pytest.raises(SceneError, match=r"0\.5 m tall; the shelf is 0\.4 m high"):
        RandomScenes(RandomOptions(object_height=0.5)).load("3")


@pytest.mark.parametrize("name", ["", "-1", "07", "a", "\uff11", "1" * 19, "1.0", " 1", "1\n"])
def test_a_name_that_is_no_seed_says_what_is(name: str) -> None:
    with pytest.raises(UnknownNameError, match="Every whole number from 0"):
        RandomScenes().load(name)


def test_the_names_listed_can_be_loaded() -> None:
    assert RandomScenes().names() == tuple("0123456789")
    for name in RandomScenes().names():
        assert RandomScenes().load(name).name == f"random/{name}"
