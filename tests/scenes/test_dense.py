"""Dense scenes: crowded as they say, their target blocked, and within reach once all else is gone."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import OptionError, SceneError
from phframe.scenes import DenseOptions, DenseScenes
from tests.scenes.seeded import alone, check_places, is_graspable, members, wall_distance

SEEDS = st.integers(0, 10**18 - 1)


@given(SEEDS)
@settings(max_examples=60, deadline=None)
def test_every_seed_gives_a_crowd_with_a_target_deep_in_it(seed: int) -> None:
    scene = DenseScenes().load(str(seed))
    assert scene.name == f"dense/{seed}"
    check_places(scene)
    assert 20 <= len(scene.objects) <= 40
    assert scene.coverage == pytest.approx(len(scene.objects) * math.pi * 0.03**2 / (0.55 * 0.61))
    assert 0.15 <= scene.coverage <= 0.35
    assert members(scene) >= 4
    assert wall_distance(scene) >= 0.055 - 1e-9


@given(SEEDS)
@settings(max_examples=30, deadline=None)
def test_the_target_is_blocked_by_obstacles_alone(seed: int) -> None:
    scene = DenseScenes().load(str(seed))
    assert not is_graspable(scene)
    assert is_graspable(alone(scene))


def test_the_listed_ones_are_different_in_number_and_obstacles_stand_behind_the_target_too() -> None:
    scenes = [DenseScenes().load(name) for name in DenseScenes().names()]
    assert len(scenes) == 30
    sizes = [len(scene.objects) for scene in scenes]
    assert min(sizes) <= 23
    assert max(sizes) >= 37
    deepest = [scene.objects[-1].position[0] for scene in scenes]
    assert all(any(item.position[0] > x for item in scene.objects) for scene, x in zip(scenes, deepest, strict=True))


def test_number_and_size_can_be_set() -> None:
    options = DenseOptions(fewest=12, most=12, radius=0.05, depth=0.7, width=0.8, wall_gap=0.1, gap=0.01)
    scene = DenseScenes(options).load("3")
    check_places(scene, gap=0.01)
    assert len(scene.objects) == 12
    assert wall_distance(scene) >= 0.15 - 1e-9


@pytest.mark.parametrize("given_", [{"fewest": 41}, {"most": 19}, {"fewest": 30, "most": 25}], ids=str)
def test_more_than_the_most_is_refused(given_: dict[str, int]) -> None:
    with pytest.raises(OptionError, match=r"scenes dense: option 'most' is \d+: less than fewest, \d+$"):
        DenseOptions.parse(given_, "scenes dense")


@pytest.mark.parametrize("given_", [{"fewest": 0}, {"most": "many"}, {"wall_gap": -1}, {"fewest": "nan"}], ids=str)
def test_options_of_the_wrong_kind_are_told_by_name(given_: dict[str, object]) -> None:
    with pytest.raises(OptionError, match=f"option '{next(iter(given_))}' is"):
        DenseOptions.parse(given_, "scenes dense")


@pytest.mark.parametrize("given_", [{"fewest": 200, "most": 200}, {"radius": 0.06}, {"wall_gap": 0.3}], ids=str)
def test_what_finds_no_place_ends_in_a_clear_error(given_: dict[str, float]) -> None:
    said = (
        r"dense/3: no place for \d+ obstacles of radius .* around a target .*; lower most, radius, blocking or wall_gap"
    )
    with pytest.raises(SceneError, match=said):
        DenseScenes(DenseOptions.parse(given_, "scenes dense")).load("3")
