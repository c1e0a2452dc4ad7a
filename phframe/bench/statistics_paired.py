"""Two planners on the same problems with the same seeds: who retrieves more, plans faster, pushes less, and how surely."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from statistics import fmean
from typing import Any

import numpy as np
from scipy.stats import binomtest, rankdata, wilcoxon

from phframe.bench.trial_result import TrialResult

Problem = tuple[str, str, int]
"""Suite, scene and seed: what two planners must share for their trials to be a pair."""
LEAST_TIME = 1e-6
"""A shorter planning time (s) counts as this one, so that times have ratios."""
EXACT = 50
"""Up to so many differences the signed-rank test is exact; numbers of choices of signs are then whole in 64 bits."""


@dataclass(frozen=True, slots=True)
class PairedComparison:
    """Two planners compared on the problems and seeds that both were given. Probabilities (p) are two-sided.

    Attributes:
        a: One planner.
        b: The other.
        pairs: Problems with a seed that both were given.
        scenes: How many scenes that are.
        both: Pairs that both retrieved.
        only_a: That only ``a`` retrieved.
        only_b: That only ``b`` retrieved.
        neither: That neither did.
        unpaired: Trials of either planner that have no partner, and are left out.
        retrieved_p: Of the exact McNemar test (McNemar 1947); with several seeds, each scene counts once, by who retrieved
            more of them.
        time_ratio: Median over scenes of ``a``'s planning time over ``b``'s, where both retrieved; None: nowhere.
        time_p: Of Wilcoxon's signed-rank test (Wilcoxon 1945) on the logarithms of these ratios; None: nowhere.
        fewer_pushes: Mean over scenes of ``b``'s pushes less ``a``'s, where both retrieved; None: nowhere.
        pushes_p: Of Wilcoxon's signed-rank test on these; None: nowhere.
    """

    a: str
    b: str
    pairs: int
    scenes: int
    both: int
    only_a: int
    only_b: int
    neither: int
    unpaired: int
    retrieved_p: float
    time_ratio: float | None
    time_p: float | None
    fewer_pushes: float | None
    pushes_p: float | None


def exact_mcnemar(only_a: int, only_b: int) -> float:
    """Two-sided p of the exact McNemar test: the binomial test of the discordant pairs; 1 where there are none."""
    discordant = only_a + only_b
    return float(binomtest(only_a, discordant).pvalue) if discordant else 1.0


def signed_rank(differences: Sequence[float]) -> float:
    """Two-sided p of Wilcoxon's signed-rank test; differences of zero are left out, and of nothing else p is 1.

    Ties share their mean rank. It is exact for up to ``EXACT`` differences, of more normal with correction for ties.
    """
    left = [difference for difference in differences if difference]
    if not left:
        return 1.0
    if len(left) <= EXACT:
        return _exact_signed_rank(left)
    return float(wilcoxon(left, method="approx", correction=True).pvalue)


def _exact_signed_rank(differences: Sequence[float]) -> float:
    """Of differences that are not zero: how many of all choices of signs have a rank sum as far out, ranks doubled to be whole."""
    ranks = np.rint(2 * rankdata(np.abs(differences))).astype(int)
    ways = np.zeros(ranks.sum() + 1, dtype=np.int64)
    ways[0] = 1
    for rank in ranks:
        ways[rank:] += ways[:-rank].copy()
    observed = ranks[np.array(differences) > 0].sum()
    tail = min(int(ways[: observed + 1].sum()), int(ways[observed:].sum()))
    return min(1.0, 2.0 * tail / 2.0 ** len(ranks))


def holm(probabilities: Sequence[float]) -> list[float]:
    """The p of several tests, adjusted for their number (Holm 1979), in the order given."""
    order = sorted(range(len(probabilities)), key=lambda i: probabilities[i])
    adjusted, running = [0.0] * len(order), 0.0
    for rank, i in enumerate(order):
        running = max(running, min(1.0, (len(order) - rank) * probabilities[i]))
        adjusted[i] = running
    return adjusted


def compare_all(by_planner: Mapping[str, Mapping[Problem, TrialResult]]) -> list[PairedComparison]:
    """Every two planners that share a problem and a seed, with p adjusted by Holm's method within each question.

    Args:
        by_planner: The results of each planner, by suite, scene and seed.
    """
    pairs = combinations(sorted(by_planner), 2)
    found = [
        compare(a, b, by_planner[a], by_planner[b]) for a, b in pairs if by_planner[a].keys() & by_planner[b].keys()
    ]
    for question in ("retrieved_p", "time_p", "pushes_p"):
        asked = [i for i, each in enumerate(found) if getattr(each, question) is not None]
        adjusted = holm([getattr(found[i], question) for i in asked])
        for i, p in zip(asked, adjusted, strict=True):
            changed: dict[str, Any] = {question: p}
            found[i] = replace(found[i], **changed)
    return found


def compare(
    a: str, b: str, of_a: Mapping[Problem, TrialResult], of_b: Mapping[Problem, TrialResult]
) -> PairedComparison:
    """Two planners on what both were given, p as it is.

    Raises:
        ValueError: If they share nothing.
    """
    common = sorted(of_a.keys() & of_b.keys())
    if not common:
        raise ValueError(f"{a} and {b} have no problem and seed in common")
    pairs = [(of_a[each], of_b[each]) for each in common]
    seen = Counter((x.retrieved, y.retrieved) for x, y in pairs)
    votes = [np.sign(value) for value in _by_scene(pairs, lambda x, y: float(x.retrieved) - float(y.retrieved))]
    solved = [(x, y) for x, y in pairs if x.retrieved and y.retrieved]
    ratios = _by_scene(solved, lambda x, y: math.log(_time(x) / _time(y)))
    pushes = _by_scene(solved, lambda x, y: float(y.pushes - x.pushes))
    return PairedComparison(
        a=a,
        b=b,
        pairs=len(common),
        scenes=len(votes),
        both=seen[True, True],
        only_a=seen[True, False],
        only_b=seen[False, True],
        neither=seen[False, False],
        unpaired=len(of_a) + len(of_b) - 2 * len(common),
        retrieved_p=exact_mcnemar(votes.count(1.0), votes.count(-1.0)),
        time_ratio=math.exp(float(np.median(ratios))) if ratios else None,
        time_p=signed_rank(ratios) if ratios else None,
        fewer_pushes=fmean(pushes) if pushes else None,
        pushes_p=signed_rank(pushes) if pushes else None,
    )


def _time(result: TrialResult) -> float:
    return max(result.planning_time, LEAST_TIME)


def _by_scene(
    pairs: Sequence[tuple[TrialResult, TrialResult]], difference: Callable[[TrialResult, TrialResult], float]
) -> list[float]:
    """The mean difference of each scene, over its seeds."""
    found: dict[tuple[str, str], list[float]] = defaultdict(list)
    for x, y in pairs:
        found[x.suite, x.problem].append(difference(x, y))
    return [fmean(each) for each in found.values()]
