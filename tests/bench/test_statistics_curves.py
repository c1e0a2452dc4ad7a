"""Curves agree with the literature, and with what must hold for any data."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.statistics_curves import ObservedTrial, logrank_p, performance_profiles, solved_over_time

# E. J. Freireich et al., Blood 21 (1963): weeks of remission of leukaemia, with 6-MP and with a placebo
SOLVED = (6, 6, 6, 7, 10, 13, 16, 22, 23)
CENSORED = (6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35)
PLACEBO = (1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23)
TREATED = [*(ObservedTrial(t, solved=True) for t in SOLVED), *(ObservedTrial(t, solved=False) for t in CENSORED)]
UNTREATED = [ObservedTrial(t, solved=True) for t in PLACEBO]
TRIALS = st.lists(st.builds(ObservedTrial, st.floats(0.001, 1e3), st.booleans()), min_size=1, max_size=30)
COST = st.one_of(st.floats(1e-3, 1e3), st.just(math.inf))


@pytest.mark.parametrize(
    ("week", "survival"),
    [(5, 1), (6, 0.857), (7, 0.807), (10, 0.753), (13, 0.690), (16, 0.627), (22, 0.538), (23, 0.448), (35, 0.448)],
)
def test_solved_over_time_is_kaplan_and_meiers(week: float, survival: float) -> None:
    assert 1 - solved_over_time(TREATED).at(week) == pytest.approx(survival, abs=5e-4)


def test_logrank_of_remissions_is_as_published() -> None:
    from scipy.stats import chi2

    assert logrank_p(TREATED, UNTREATED) == pytest.approx(chi2.sf(16.79, 1), rel=0.01)
    assert logrank_p([ObservedTrial(1.0, solved=False)], [ObservedTrial(1.0, solved=False)]) is None


@given(TRIALS)
def test_solved_over_time_rises_within_its_band(trials: list[ObservedTrial]) -> None:
    curve = solved_over_time(trials)
    assert (np.diff(curve.x) > 0).all()
    assert (np.diff(curve.y, prepend=0.0) > 0).all()
    assert (curve.y <= 1 + 1e-12).all()
    told = np.isfinite(curve.low) & np.isfinite(curve.high)
    assert (curve.low[told] <= curve.y[told] + 1e-9).all()
    assert (curve.y[told] <= curve.high[told] + 1e-9).all()


@given(TRIALS)
def test_what_is_censored_at_the_end_makes_a_plain_fraction(trials: list[ObservedTrial]) -> None:
    late = [trial if trial.solved else ObservedTrial(2e3, solved=False) for trial in trials]
    solved = sum(trial.solved for trial in trials)
    assert solved_over_time(late).at(1.5e3) == pytest.approx(solved / len(trials))


def test_a_performance_profile_by_hand() -> None:
    found = performance_profiles({"a": [1.0, 2.0, math.inf, math.inf], "b": [2.0, 2.0, 5.0, math.inf]})
    assert [found["a"].at(x) for x in (0.9, 1, 2, 100)] == [0, 0.5, 0.5, 0.5]
    assert [found["b"].at(x) for x in (1, 1.9, 2, 100)] == [0.5, 0.5, 0.75, 0.75]


@given(st.integers(1, 6).flatmap(lambda n: st.lists(st.lists(COST, min_size=n, max_size=n), min_size=1, max_size=4)))
def test_a_profile_ends_at_what_is_solved_and_somebody_is_best(costs: list[list[float]]) -> None:
    found = performance_profiles({str(i): row for i, row in enumerate(costs)})
    for i, row in enumerate(costs):
        assert found[str(i)].at(math.inf) == pytest.approx(np.isfinite(row).mean())
    solvable = np.isfinite(np.min(costs, axis=0)).mean()
    assert sum(curve.at(1.0) for curve in found.values()) >= solvable - 1e-9


@pytest.mark.parametrize("wrong", [{}, {"a": []}, {"a": [0.0]}, {"a": [math.nan]}])
def test_no_costs_are_refused(wrong: dict[str, list[float]]) -> None:
    with pytest.raises(ValueError, match="costs are"):
        performance_profiles(wrong)
