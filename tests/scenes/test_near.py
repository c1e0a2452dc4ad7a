"""Scenes with a target near a side wall: near which, how near, and within reach once all else is gone."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import SceneError
from phframe.scenes import NearOptions, NearScenes
from tests.scenes.seeded import alone, check_places, corridor_to_target, is_graspable, members, target_of, wall_distance

SEEDS = st.integers(0, 10**18 - 1)
W, R = 0.12, 0.03


@given(SEEDS)
@settings(max_examples=60, deadline=None)
def test_every_seed_gives_a_blocked_target_near_a_wall(seed: int) -> None:
    scene = NearScenes().load(str(seed))
    assert scene.name == f"near/{seed}"
    check_places(scene)
    assert len(scene.objects) == 10
    assert R + 0.01 - 1e-9 <= wall_distance(scene) <= 1.5 * W + 1e-9
    assert all(item.position[0] < target_of(scene)[0] for item in scene.objects[:-1])
    assert members(scene) >= 2


@given(SEEDS)
@settings(max_examples=30, deadline=None)
def test_the_target_is_within_reach_of_an_empty_shelf(seed: int) -> None:
    assert is_graspable(alone(NearScenes().load(str(seed))))


def test_the_listed_ones_are_of_every_kind_on_both_sides() -> None:
    scenes = [NearScenes().load(name) for name in NearScenes().names()]
    assert len(scenes) == 30
    distances = [wall_distance(scene) for scene in scenes]
    within, between = [d < W for d in distances], [W <= d < W + R for d in distances]
    assert 8 <= sum(within) <= 12
    assert 8 <= sum(between) <= 12
    assert 2 <= sum(d < 0.052 for d in distances) <= 5  # where only the tight grasp fits
    north = [target_of(scene)[1] > scene.shelf.width / 2.0 for scene in scenes]
    assert 8 <= sum(north) <= 22
    for scene, angled, beyond in zip(scenes, within, north, strict=True):
        assert corridor_to_target(scene).beside == (("north" if beyond else "south") if angled else None)


@given(SEEDS, st.floats(0.05, 0.4))
@settings(max_examples=40, deadline=None)
def test_how_near_can_be_set(seed: int, beside: float) -> None:
    scene = NearScenes(NearOptions(beside=beside, wall_gap=0.02, count=3)).load(str(seed))
    assert 0.05 - 1e-9 <= wall_distance(scene) <= beside
    check_places(scene)


@pytest.mark.parametrize("given_", [{"beside": 0.03}, {"wall_gap": 0.2}, {"width": 0.07}, {"count": 200}], ids=str)
def test_what_finds_no_place_ends_in_a_clear_error(given_: dict[str, float]) -> None:
    said = r"near/3: no place for \d+ obstacles of radius .* so near to a side wall .*; lower count, .* raise beside"
    with pytest.raises(SceneError, match=said):
        NearScenes(NearOptions.parse(given_, "scenes near")).load("3")
