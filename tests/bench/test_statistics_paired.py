"""Paired tests agree with the literature, and compare what is paired only."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.statistics_paired import Problem, compare, compare_all, exact_mcnemar, holm, signed_rank
from phframe.bench.trial_result import TrialEnd, TrialResult

PLAIN = TrialResult("", "s", "s/0", "a", "pymunk", "planar", "pymunk", "planar", 0, "{}", TrialEnd.FINISHED)
P = st.floats(0, 1)


def trials(*retrieved: bool, seeds: int = 1, **figures: float) -> dict[Problem, TrialResult]:
    rows = [
        replace(PLAIN, problem=f"s/{i}", seed=seed, retrieved=won, **figures)  # type: ignore[arg-type]
        for i, won in enumerate(retrieved)
        for seed in range(seeds)
    ]
    return {(row.suite, row.problem, row.seed): row for row in rows}


def test_mcnemar_by_hand() -> None:
    assert exact_mcnemar(1, 9) == pytest.approx(2 * (1 + 10) / 1024)
    assert exact_mcnemar(9, 1) == exact_mcnemar(1, 9)
    assert exact_mcnemar(0, 0) == 1.0


def test_signed_rank_of_darwins_maize() -> None:
    # C. Darwin 1876 by R. A. Fisher, The Design of Experiments (1935); exact p of W = 24 at n = 15
    darwin = [6.0, 8.0, 14.0, 16.0, 23.0, 24.0, 28.0, 29.0, 41.0, -48.0, 49.0, 56.0, 60.0, -67.0, 75.0]
    assert signed_rank(darwin) == pytest.approx(0.041259765625)
    assert signed_rank([*darwin, 0.0, 0.0]) == signed_rank(darwin)


@pytest.mark.parametrize(
    ("differences", "p"),
    [
        ([1.0] * 5, 2 / 2**5),
        ([1.0, 1.0, 1.0, 1.0, 2.0], 2 / 2**5),
        ([1.0] * 6, 2 / 2**6),
        ([1.0, 1.0, -1.0], 1.0),
        (
            [-1.0, 1.0, 2.0, 2.0, 3.0],
            6 / 2**5,
        ),  # ranks 1.5, 1.5, 3.5, 3.5, 5: sums of 1.5 or less are of none, or of either 1.5
        ([1.0] * 50, 2 / 2**50),
    ],
    ids=str,
)
def test_signed_rank_is_exact_with_ties_too(differences: list[float], p: float) -> None:
    assert signed_rank(differences) == p
    assert signed_rank([-each for each in differences]) == p


def test_signed_rank_of_many_is_normal_and_of_nothing_is_1() -> None:
    assert 0.9 < signed_rank([(-1.0) ** i * (i // 2 + 1) for i in range(60)]) <= 1.0
    assert signed_rank([1.0] * 60) < 1e-9
    assert signed_rank([0.0, 0.0]) == signed_rank([]) == 1.0


def test_holm_by_hand() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])


@given(st.lists(P, max_size=12))
def test_holm_raises_keeps_the_order_and_is_below_bonferroni(given_p: list[float]) -> None:
    adjusted = holm(given_p)
    for p, q in zip(given_p, adjusted, strict=True):
        assert p <= q <= min(1.0, len(given_p) * p) or q == pytest.approx(max(p, min(1.0, q)))
        assert q <= 1
    ranked = sorted(zip(given_p, adjusted, strict=True))
    assert [q for _, q in ranked] == sorted(adjusted)


def test_only_pairs_are_compared_and_the_rest_is_counted() -> None:
    a, b = trials(True, True, True, False), trials(True, False, False, False)
    del b["s", "s/3", 0]
    b["s", "s/9", 0] = replace(PLAIN, problem="s/9", retrieved=True)
    found = compare("a", "b", a, b)
    assert (found.pairs, found.both, found.only_a, found.only_b, found.neither, found.unpaired) == (3, 1, 2, 0, 0, 2)
    assert found.retrieved_p == exact_mcnemar(2, 0)


def test_planners_that_share_nothing_are_not_compared() -> None:
    a, b = trials(True), {("s", "s/9", 0): PLAIN}
    assert compare_all({"a": a, "b": b}) == []
    with pytest.raises(ValueError, match="in common"):
        compare("a", "b", a, b)


def test_seeds_that_agree_add_no_certainty() -> None:
    once = compare("a", "b", trials(*[True] * 6, False), trials(*[False] * 6, True))
    many = compare("a", "b", trials(*[True] * 6, False, seeds=5), trials(*[False] * 6, True, seeds=5))
    assert many.only_a == 5 * once.only_a == 30
    assert many.retrieved_p == once.retrieved_p == exact_mcnemar(6, 1)


def test_times_and_pushes_are_of_what_both_retrieved() -> None:
    a = trials(*[True] * 8, planning_time=0.2, pushes=2)
    b = trials(*[True] * 6, False, False, planning_time=0.1, pushes=5)
    found = compare("a", "b", a, b)
    assert found.time_ratio == pytest.approx(2.0)
    assert found.fewer_pushes == 3.0
    assert found.time_p == signed_rank([1.0] * 6)
    none = compare("a", "b", trials(True), trials(False))
    assert (none.time_ratio, none.time_p, none.fewer_pushes, none.pushes_p) == (None, None, None, None)


def test_many_comparisons_are_adjusted() -> None:
    by_planner = {"a": trials(*[True] * 8), "b": trials(*[False] * 8), "c": trials(*[False] * 7, True)}
    alone = {(x.a, x.b): x.retrieved_p for x in [compare("a", "b", by_planner["a"], by_planner["b"])]}
    found = {(x.a, x.b): x.retrieved_p for x in compare_all(by_planner)}
    assert list(found) == [("a", "b"), ("a", "c"), ("b", "c")]
    assert found["a", "b"] == pytest.approx(3 * alone["a", "b"])


@given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=20))
def test_a_comparison_turned_round_says_the_same(outcomes: list[tuple[bool, bool]]) -> None:
    a, b = (trials(*each, planning_time=0.1 * (i + 1)) for i, each in enumerate(zip(*outcomes, strict=True)))
    there, back = compare("a", "b", a, b), compare("b", "a", b, a)
    assert (there.only_a, there.only_b, there.both) == (back.only_b, back.only_a, back.both)
    assert there.retrieved_p == pytest.approx(back.retrieved_p)
    assert there.pairs == there.both + there.only_a + there.only_b + there.neither
    if there.time_ratio is not None:
        assert back.time_ratio == pytest.approx(1 / there.time_ratio)
