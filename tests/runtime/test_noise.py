"""What the planner believes differs from what is true, by as much as was asked for, and only then."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import phframe
from phframe.core import Episode, InputError, OptionError, Scene, coulomb_with_board
from phframe.runtime.noise import FRICTION, POSITIONS, Noise
from phframe.runtime.scenes import find_scene
from phframe.runtime.summary import summarize
from tests.runtime.worlds import BASIC

BOTH = "position=0.005,friction=0.3"


def test_text_and_mappings_say_the_same() -> None:
    assert Noise.of(" position = 0.005 , friction=0.3") == Noise.of({"position": 0.005, "friction": "0.3"})
    assert Noise.of(BOTH) == Noise(position=0.005, friction=0.3)
    assert Noise.of(None) == Noise.of({}) == Noise()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ("position=-1", ["'position'", "'-1'", "greater than or equal to 0"]),
        ("position=1", ["'position'", "less than or equal to 0.05"]),
        ("friction=nan", ["'friction'", "finite"]),
        ("friction=much", ["'friction'", "'much'"]),
        ("nonsense=3", ["'nonsense'", "friction, position"]),
        ("posytion=0.01", ["Did you mean 'position'?"]),
        ("position", ["'position' is not of the form", "friction, position"]),
        ("", ["not of the form", "friction, position"]),
        ("position=0.01,", ["not of the form"]),
        ("position=0.01,position=0.02", ["given twice", "'0.01'", "'0.02'"]),
        ({"position": -1.0}, ["'position'"]),
        ({3: 0.1}, ["mapping by name"]),
        (0.005, ["position=0.005,friction=0.3"]),
    ],
)
def test_what_cannot_be_is_refused_before_anything_runs(wrong: Any, words: list[str]) -> None:
    with pytest.raises(OptionError) as caught:
        phframe.solve(noise=wrong)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


@given(st.text())
def test_any_text_is_noise_or_an_input_error(text: str) -> None:
    try:
        noise = Noise.of(text)
    except InputError:
        return
    assert 0.0 <= noise.position <= 0.05
    assert 0.0 <= noise.friction <= 1.0


def test_friction_is_off_by_log_normal_factors_of_that_spread_and_nothing_else() -> None:
    crowd = find_scene("random/1", {"count": 20})
    believed = [Noise(friction=0.3).believed(crowd, seed) for seed in range(200)]
    factors = np.array([[_friction(scene, row) / _friction(crowd, row) for row in range(21)] for scene in believed])
    assert factors.min() > 0.0
    assert factors.mean() == pytest.approx(1.0, abs=0.02)
    assert factors.std() == pytest.approx(0.3, abs=0.02)
    assert np.log(factors).std() == pytest.approx(np.sqrt(np.log1p(0.09)), abs=0.01)
    restored = tuple(replace(b, friction=o.friction) for b, o in zip(believed[0].objects, crowd.objects, strict=True))
    assert replace(believed[0], objects=restored) == crowd


def _friction(scene: Scene, row: int) -> float:
    return coulomb_with_board(scene, scene.objects[row])


def test_an_objects_own_friction_counts() -> None:
    objects = (replace(BASIC.objects[0], friction=0.7), *BASIC.objects[1:])
    own = replace(BASIC, objects=objects)
    ratio = _friction(Noise(friction=0.3).believed(own, 1), 0) / _friction(Noise(friction=0.3).believed(BASIC, 1), 0)
    assert ratio == pytest.approx(0.7 / BASIC.shelf.board_friction)


def test_without_friction_noise_the_scene_is_the_same_one() -> None:
    assert Noise(position=0.01).believed(BASIC, 3) is BASIC


def test_the_streams_are_of_the_seed_and_apart_from_the_planners() -> None:
    noise, seeds = Noise(), np.random.SeedSequence(4)
    draws = [noise.stream(4, part).random() for part in (POSITIONS, FRICTION)]
    draws += [noise.stream(5, POSITIONS).random()]
    draws += [np.random.default_rng(child).random() for child in seeds.spawn(10)]
    assert len(set(draws)) == len(draws)
    assert noise.stream(4, POSITIONS).random() == draws[0]


def test_the_same_seed_gives_the_same_bits_and_another_seed_others(tmp_path: Path) -> None:
    one, two, other = (phframe.solve(BASIC, noise=BOTH, seed=seed) for seed in (1, 1, 2))
    assert one == two
    assert one.plans[0].expected[0] != other.plans[0].expected[0]
    assert dict(one.spec.noise) == {"position": 0.005, "friction": 0.3}
    assert summarize(one)["noise"] == {"position": 0.005, "friction": 0.3}
    assert phframe.load(phframe.save(one, tmp_path / "episode.json")) == one


def test_no_noise_is_as_if_nobody_had_asked() -> None:
    plain = phframe.solve(BASIC)
    assert phframe.solve(BASIC, noise="position=0,friction=0") == plain
    assert summarize(plain)["noise"] == {}


def test_friction_noise_leaves_the_world_and_its_options_alone() -> None:
    plain, noisy = (phframe.solve(BASIC, noise=noise, options={"backend": {"step": 0.004}}) for noise in (None, BOTH))
    assert noisy.scene == plain.scene
    assert noisy.spec.options == plain.spec.options
    assert noisy.steps[0].before == plain.steps[0].before


def test_what_was_not_seen_right_is_not_where_it_was_expected() -> None:
    """Planned, carried out and judged on the same engine: the errors of the prediction are the noise's."""
    plain, noisy = (_median_error(phframe.solve(BASIC, noise=noise)) for noise in (None, "position=0.005"))
    assert plain < 1e-4
    assert noisy > 1e-3


def _median_error(episode: Episode) -> float:
    return float(np.median(episode.prediction_errors))


def test_the_replan_tolerance_is_of_what_is_seen() -> None:
    wide, narrow = (phframe.solve(BASIC, noise="position=0.003", tolerance=tolerance) for tolerance in (0.2, 1e-4))
    assert (wide.replans, str(wide.status)) == (0, "retrieved")
    assert narrow.replans > 0


@pytest.mark.slow
def test_most_scenes_are_solved_all_the_same() -> None:
    names = [f"vieira/example-{number:02}" for number in range(1, 11)]
    assert sum(str(phframe.solve(name, noise=BOTH).status) == "retrieved" for name in names) >= 8
