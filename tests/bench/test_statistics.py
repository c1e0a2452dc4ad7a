"""Intervals agree with the literature, with scipy, and with what must hold for any data."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binomtest, ttest_1samp

from phframe.bench.statistics import effective_trials, success_rate, typical, wilson

LISTS = st.lists(st.booleans(), min_size=1, max_size=5)
BY_SCENE = st.dictionaries(st.text(max_size=3), LISTS, min_size=1, max_size=12)
FIGURES = st.floats(-1e3, 1e3, width=32)


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)  # R. G. Newcombe, Statistics in Medicine 17 (1998), table I, method 3
def test_wilson_is_as_published(successes: int, trials: int, low: float, high: float) -> None:
    assert wilson(successes, trials) == pytest.approx((low, high), abs=5e-5)


@given(st.integers(1, 500), st.data())
def test_wilson_is_scipys_and_holds_the_rate(trials: int, data: st.DataObject) -> None:
    successes = data.draw(st.integers(0, trials))
    low, high = wilson(successes, trials)
    scipys = binomtest(successes, trials).proportion_ci(method="wilson")
    assert (low, high) == pytest.approx((scipys.low, scipys.high), abs=1e-9)
    assert 0 <= low <= successes / trials <= high <= 1


@pytest.mark.parametrize("wrong", [(1, 0), (-1, 5), (6, 5)])
def test_no_proportion_is_refused(wrong: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="no proportion"):
        wilson(*wrong)


def test_seeds_that_agree_add_no_certainty() -> None:
    once = {f"s{i}": [i < 7] for i in range(10)}
    thrice = {scene: found * 3 for scene, found in once.items()}
    assert effective_trials(once) == 10
    assert effective_trials(thrice) == pytest.approx(10)
    a, b = success_rate(once), success_rate(thrice)
    assert (b.value, b.low, b.high) == pytest.approx((a.value, a.low, a.high))
    assert (a.trials, b.trials, b.scenes) == (10, 30, 10)


def test_seeds_that_differ_within_scenes_count_in_full() -> None:
    assert effective_trials({f"s{i}": [True, False] for i in range(10)}) == 20


@given(BY_SCENE)
def test_effective_trials_lie_between_scenes_and_trials(by_scene: dict[str, list[bool]]) -> None:
    trials, rate = sum(map(len, by_scene.values())), success_rate(by_scene)
    assert 0 < effective_trials(by_scene) <= trials + 1e-9
    assert rate.low is not None
    assert rate.value is not None
    assert rate.high is not None
    assert rate.low <= rate.value + 1e-12
    assert rate.value <= rate.high + 1e-12


def test_nothing_has_no_rate() -> None:
    assert success_rate({}).value is None
    assert typical([{}]).value is None


def test_bca_of_a_mean_is_near_students_interval() -> None:
    # spatial test A of B. Efron and R. Tibshirani, An Introduction to the Bootstrap (1993), table 14.1
    a = [48, 36, 20, 29, 42, 42, 20, 42, 22, 41, 45, 14, 6, 0, 33, 28, 34, 4, 32, 24, 47, 41, 24, 26, 30, 41]
    found, students = typical([{str(i): [float(x)] for i, x in enumerate(a)}], resamples=4000), ttest_1samp(a, 0.0)
    assert found.value == pytest.approx(np.mean(a))
    low, high = students.confidence_interval()
    assert (found.low, found.high) == pytest.approx((low, high), abs=1.0)


def test_a_bootstrap_covers_as_often_as_it_says() -> None:
    rng = np.random.default_rng(1)
    hits = 0
    for _ in range(200):
        found = typical([{str(i): [x] for i, x in enumerate(rng.exponential(1.0, 40))}], resamples=400)
        assert found.low is not None
        assert found.high is not None
        hits += found.low <= 1.0 <= found.high
    assert 0.89 <= hits / 200 <= 0.99


def test_the_strata_are_kept_apart() -> None:
    apart = [{f"a{i}": [0.0 + i % 2] for i in range(20)}, {f"b{i}": [100.0 + i % 2] for i in range(20)}]
    together = [{**apart[0], **apart[1]}]
    narrow, wide = typical(apart), typical(together)
    assert narrow.value == wide.value
    assert narrow.low is not None
    assert narrow.high is not None
    assert wide.low is not None
    assert wide.high is not None
    assert narrow.high - narrow.low < 0.5 < 20 < wide.high - wide.low


@pytest.mark.parametrize("statistic", ["mean", "median"])
def test_the_seeds_of_a_scene_count_once(statistic: str) -> None:
    once = {str(i): [float(i)] for i in range(12)}
    many = {scene: [found[0] - 1, found[0], found[0] + 1] for scene, found in once.items()}
    a, b = typical([once], statistic), typical([many], statistic)  # type: ignore[arg-type]
    assert (a.value, a.low, a.high, a.scenes) == (b.value, b.low, b.high, b.scenes)
    assert (a.trials, b.trials) == (12, 36)


def test_a_single_scene_has_no_interval_and_equal_ones_have_no_width() -> None:
    assert typical([{"s": [3.0, 5.0]}]).low is None
    assert typical([{"s": [3.0, 5.0]}]).value == 4.0
    equal = typical([{"s": [2.0], "t": [2.0]}, {"u": [2.0]}])
    assert (equal.low, equal.high) == (2.0, 2.0)


@given(st.lists(st.lists(FIGURES, max_size=8), min_size=1, max_size=3), st.sampled_from(["mean", "median"]))
def test_an_interval_lies_within_the_data_and_is_the_same_again(figures: list[list[float]], statistic: str) -> None:
    strata = [{str(i): [x] for i, x in enumerate(each)} for each in figures]
    found = typical(strata, statistic, resamples=50)  # type: ignore[arg-type]
    assert found == typical(strata, statistic, resamples=50)  # type: ignore[arg-type]
    everything = [x for each in figures for x in each]
    assert found.scenes == len(everything)
    if found.low is not None and found.high is not None:
        slack = 1e-9 * (1 + max(map(abs, everything)))
        assert min(everything) - slack <= found.low <= found.high <= max(everything) + slack
