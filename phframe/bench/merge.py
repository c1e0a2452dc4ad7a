"""Several benches as one: their results together, each trial once."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import combinations
from pathlib import Path

from phframe.bench.conflicts import Accept, refused
from phframe.bench.merge_conflicts import (
    SHOWN,
    MergeConflictError,
    ResultConflictError,
    ResultDifference,
    bench_differences,
    result_differences,
)
from phframe.bench.settings import BenchSettings
from phframe.bench.store import ResultStore
from phframe.bench.trial_result import TrialResult
from phframe.core.files import new_folder


class Preference(StrEnum):
    """Which of several results of one trial is taken, in the order in which the benches are given."""

    FIRST = "first"
    LAST = "last"


@dataclass(frozen=True, slots=True)
class MergeSummary:
    """What came together.

    Attributes:
        results: How many there are now.
        shared: How often a bench brought one that an earlier bench has.
        left_out: How many are left out, for they are on another scene of the same name than the first bench's.
    """

    results: int
    shared: int
    left_out: int = 0


def merge_benches(
    directories: Sequence[Path], out: Path, *, accept: Collection[Accept] = (), prefer: Preference | None = None
) -> MergeSummary:
    """Write a new bench that holds the results of several, which stay as they are.

    A trial that several have is kept once, with the times of the first. Suites and planners are those of all, seeds the
    most; whatever else differs and is accepted is the first one's. Results that are no part of their bench any more, and
    those on another scene than the first bench has under that name, are left out.

    Args:
        directories: The benches.
        out: The new directory; it appears whole or not at all.
        accept: In what they may differ.
        prefer: Whose result is taken where a trial came out differently; None: that is refused.

    Raises:
        MergeConflictError: If they differ in anything else.
        ResultConflictError: If a trial came out differently, and no result is preferred.
        InputError: If one holds no bench, or the new one cannot be written.
    """
    with ExitStack() as opened, new_folder(out) as made:
        stores = [opened.enter_context(ResultStore.open(directory)) for directory in directories]
        differences = [each for pair in combinations(stores, 2) for each in bench_differences(*pair)]
        if wrong := refused(differences, accept):
            raise MergeConflictError(list(dict.fromkeys(wrong)))
        problems = {name: digest for store in reversed(stores) for name, digest in store.problems().items()}
        with ResultStore.create(made, _together([store.settings for store in stores]), problems) as merged:
            return _Merging(merged, prefer).all_of(stores)


class _Merging:
    """Results coming together in one store."""

    def __init__(self, merged: ResultStore, prefer: Preference | None) -> None:
        self._merged, self._prefer = merged, prefer
        self._refused: list[ResultDifference] = []
        self._scenes = merged.problems()
        self._count = self._stored = self._shared = self._left_out = 0

    def all_of(self, stores: Sequence[ResultStore]) -> MergeSummary:
        """Take in all results of some stores."""
        for store in stores:
            for environment in store.environments().values():
                self._merged.add_environment(environment)
            other = {name for name, digest in store.problems().items() if self._scenes[name] != digest}
            for result in store.results():
                if result.problem in other:
                    self._left_out += 1
                else:
                    self._take(result, store)
        if self._count:
            raise ResultConflictError(self._refused, self._count)
        return MergeSummary(self._stored, self._shared, self._left_out)

    def _take(self, result: TrialResult, store: ResultStore) -> None:
        if self._merged.add(result, fault=store.fault(result.key)):
            self._stored += 1
            return
        self._shared += 1
        known = self._merged.result(result.key)
        assert known is not None, "it was not stored, for there is one"
        found = list(result_differences(known, result))
        if found and self._prefer is Preference.LAST:
            self._merged.add(result, fault=store.fault(result.key), replace=True)
        if found and self._prefer is None:
            self._count += len(found)
            self._refused += found[: SHOWN - len(self._refused)]


def _together(settings: Sequence[BenchSettings]) -> BenchSettings:
    """The settings of the first, for the suites, planners and seeds of all."""
    return replace(
        settings[0],
        suites=tuple(dict.fromkeys(suite for each in settings for suite in each.suites)),
        planners=tuple(dict.fromkeys(planner for each in settings for planner in each.planners)),
        seeds=max(each.seeds for each in settings),
    )
