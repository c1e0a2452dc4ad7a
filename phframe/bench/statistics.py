"""Intervals for rates, means and medians of trials. What is drawn at random is the scene: its seeds do not count as scenes."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Any, Literal

import numpy as np
from scipy.stats import bootstrap, norm

from phframe.core import FloatArray

LEVEL = 0.95
"""Confidence level of all intervals."""
RESAMPLES, LEAST_RESAMPLES, DRAWS = 2000, 400, 4_000_000
"""Of a bootstrap: as many as need no more draws than this, within these bounds."""
MANY = 2000
"""From so many scenes on, the bootstrap's interval is the percentile one: the correction of BCa, of order 1/n, has no use."""

Statistic = Literal["mean", "median"]
_FUNCTIONS: Mapping[Statistic, Any] = {"mean": np.mean, "median": np.median}


@dataclass(frozen=True, slots=True)
class Estimate:
    """A figure with its interval.

    Attributes:
        value: The figure; None: there is nothing to take it from.
        low: Lower end of the interval; None: it cannot be told, as of a single scene.
        high: Upper end; None likewise.
        trials: How many trials it is from.
        scenes: How many scenes.
    """

    value: float | None
    low: float | None
    high: float | None
    trials: int
    scenes: int


def wilson(successes: float, trials: float, level: float = LEVEL) -> tuple[float, float]:
    """Wilson's score interval of a proportion (Wilson 1927).

    Args:
        successes: How many; need not be whole, as of an effective number of trials.
        trials: Of how many.
        level: Confidence.

    Raises:
        ValueError: If there are no trials, or more successes than trials.
    """
    if not (trials > 0 and 0 <= successes <= trials):
        raise ValueError(f"{successes:g} of {trials:g} is no proportion")
    z = float(norm.ppf((1 + level) / 2))
    p, shrink = successes / trials, 1 + z**2 / trials
    middle = (p + z**2 / (2 * trials)) / shrink
    half = z / shrink * math.sqrt(p * (1 - p) / trials + z**2 / (4 * trials**2))
    return (0.0 if successes == 0 else middle - half, 1.0 if successes == trials else middle + half)


def effective_trials(by_scene: Mapping[str, Sequence[bool]]) -> float:
    """How many independent trials the trials of some scenes are worth: their number over Kish's design effect (Kish 1965).

    One trial a scene: all of them. Trials that agree within each scene: as many as there are scenes.
    """
    trials = sum(map(len, by_scene.values()))
    rate = sum(map(sum, by_scene.values())) / trials
    if rate in (0.0, 1.0):  # nothing tells how alike the seeds of a scene are
        return float(len(by_scene))
    between = sum((sum(found) - rate * len(found)) ** 2 for found in by_scene.values())
    return trials / max(1.0, between / (trials * rate * (1 - rate)))


def success_rate(by_scene: Mapping[str, Sequence[bool]], level: float = LEVEL) -> Estimate:
    """The rate of successes, with Wilson's interval at the effective number of trials (Franco et al. 2019).

    With one seed a scene this is Wilson's interval.

    Args:
        by_scene: Whether each trial succeeded, by scene; no scene without a trial.
        level: Confidence.
    """
    trials = sum(map(len, by_scene.values()))
    if not trials:
        return Estimate(None, None, None, 0, 0)
    rate, worth = sum(map(sum, by_scene.values())) / trials, effective_trials(by_scene)
    low, high = wilson(rate * worth, worth, level)
    return Estimate(rate, low, high, trials, len(by_scene))


def typical(
    strata: Sequence[Mapping[str, Sequence[float]]],
    statistic: Statistic = "mean",
    *,
    seed: int = 0,
    level: float = LEVEL,
    resamples: int = RESAMPLES,
) -> Estimate:
    """The mean or median over scenes, with a bootstrap interval by scene, stratified.

    The seeds of a scene are averaged first, so that each scene counts once. The interval is BCa (Efron 1987), the
    percentile one where BCa does not exist or there are ``MANY`` scenes. A stratum of a single scene stays as it is.

    Args:
        strata: For each suite, the figures of the trials by scene.
        statistic: What is taken over scenes.
        seed: Of the resampling.
        level: Confidence.
        resamples: How many at most; fewer where there are more than ``MANY`` scenes.
    """
    samples = [np.array([fmean(found) for found in stratum.values() if found]) for stratum in strata]
    everything = np.concatenate([*samples, np.zeros(0)])
    trials = sum(len(found) for stratum in strata for found in stratum.values())
    if not everything.size:
        return Estimate(None, None, None, 0, 0)
    value = float(_FUNCTIONS[statistic](everything))
    low, high = _bootstrapped(samples, statistic, seed, level, resamples)
    return Estimate(value, low, high, trials, everything.size)


def _bootstrapped(
    samples: Sequence[FloatArray], statistic: Statistic, seed: int, level: float, resamples: int
) -> tuple[float | None, float | None]:
    drawn = [sample for sample in samples if sample.size > 1]
    fixed = np.concatenate([*(sample for sample in samples if sample.size == 1), np.zeros(0)])
    if not drawn:
        return None, None
    if all((sample == drawn[0][0]).all() for sample in (*drawn, fixed)):
        return float(drawn[0][0]), float(drawn[0][0])
    function = _FUNCTIONS[statistic]

    def pooled(*found: FloatArray, axis: int) -> Any:
        still = np.broadcast_to(fixed, (*found[0].shape[:-1], fixed.size))
        return function(np.concatenate([*found, still], axis=axis), axis=axis)

    many = sum(sample.size for sample in drawn) >= MANY
    resamples = min(resamples, max(LEAST_RESAMPLES, DRAWS // sum(sample.size for sample in drawn)))
    for method in ("percentile",) if many else ("BCa", "percentile"):
        low, high = _interval(drawn, pooled, method, seed, level, resamples)
        if math.isfinite(low) and math.isfinite(high):
            return low, high
    return None, None


def _interval(
    drawn: Sequence[FloatArray], pooled: Any, method: str, seed: int, level: float, resamples: int
) -> tuple[float, float]:
    untyped: Any = bootstrap  # its types know of no method that is chosen while running
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")  # of degenerate data: the interval is then not a number, and another is taken
        found = untyped(
            tuple(drawn), pooled, n_resamples=resamples, batch=200, vectorized=True, axis=-1,
            confidence_level=level, method=method, rng=np.random.default_rng(seed),
        )  # fmt: skip
    interval = found.confidence_interval
    return float(interval.low), float(interval.high)
