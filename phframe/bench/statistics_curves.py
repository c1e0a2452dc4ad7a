"""Curves over trials: how many are solved by when, and how far from the best a planner is."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import CensoredData, ecdf, logrank

from phframe.bench.statistics import LEVEL
from phframe.core import FloatArray, Value


@dataclass(frozen=True, slots=True, eq=False)
class Curve(Value):
    """A curve of steps: ``y`` holds from its ``x`` on, and before the first ``x`` it is 0.

    Attributes:
        x: Where it steps, rising, ``(k,)``.
        y: Fraction of all trials from there on, ``(k,)``.
        low: Lower end of its band, ``(k,)``, not a number where it has none; empty: it has none anywhere.
        high: Upper end likewise.
    """

    x: FloatArray
    y: FloatArray
    low: FloatArray
    high: FloatArray

    def __post_init__(self) -> None:
        self._freeze("x", "y", "low", "high")

    def at(self, x: float) -> float:
        """The fraction at ``x``."""
        step = int(np.searchsorted(self.x, x, side="right")) - 1
        return float(self.y[step]) if step >= 0 else 0.0


@dataclass(frozen=True, slots=True)
class ObservedTrial:
    """How long a trial was observed, and whether it was solved then.

    Attributes:
        time: At which it was solved, or until which it was not (s).
        solved: Whether it was.
    """

    time: float
    solved: bool


def solved_over_time(trials: Sequence[ObservedTrial], level: float = LEVEL) -> Curve:
    """The fraction solved by each time: one less the product-limit estimate (Kaplan and Meier 1958).

    The band is of Greenwood's variance, on the scale of log(-log).

    Args:
        trials: At least one; those not solved are right-censored.
        level: Confidence of the band at each time.
    """
    if not any(trial.solved for trial in trials):
        return Curve(*(np.zeros(0) for _ in range(4)))
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")  # there is no band where all or nothing is solved
        cdf: Any = ecdf(_censored(trials)).cdf
        band = cdf.confidence_interval(level, method="log-log")
    kept = np.flatnonzero(np.diff(cdf.probabilities, prepend=0.0) > 0)
    low, high = (np.asarray(end.probabilities)[kept] for end in (band.low, band.high))
    return Curve(np.asarray(cdf.quantiles)[kept], np.asarray(cdf.probabilities)[kept], low, high)


def logrank_p(a: Sequence[ObservedTrial], b: Sequence[ObservedTrial]) -> float | None:
    """Two-sided p of the log-rank test (Mantel 1966) that two are solved alike fast; None: nothing is solved."""
    if not any(trial.solved for trial in (*a, *b)):
        return None
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        p = float(logrank(_censored(a), _censored(b)).pvalue)
    return p if np.isfinite(p) else 1.0


def _censored(trials: Sequence[ObservedTrial]) -> CensoredData:
    times = np.array([trial.time for trial in trials])
    return CensoredData.right_censored(times, np.array([not trial.solved for trial in trials]))


def performance_profiles(costs: Mapping[str, Sequence[float]]) -> dict[str, Curve]:
    """On what fraction of the problems a planner's cost is within a factor of the best one's (Dolan and Moré 2002).

    Args:
        costs: Of each planner on the same problems in the same order, above 0; infinite where it did not solve the problem.

    Returns:
        For each planner the fraction of all problems, also of those that nobody solved, over the factor.

    Raises:
        ValueError: If there are no problems, or not the same number for each, or a cost is not above 0.
    """
    table = np.array(list(costs.values()), dtype=float)
    if table.ndim != 2 or not table.size or not (table > 0).all():
        raise ValueError("costs are numbers above 0, of each planner on the same problems")
    best = table.min(axis=0)
    found = {}
    for name, row in zip(costs, table, strict=True):
        solved = np.isfinite(row)
        factors, counts = np.unique(row[solved] / best[solved], return_counts=True)
        found[name] = Curve(factors, np.cumsum(counts) / table.shape[1], np.zeros(0), np.zeros(0))
    return found
