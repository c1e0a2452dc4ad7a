"""A bench at work: what is to be done in a directory, and doing it."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Collection, Generator, Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from types import TracebackType
from typing import Self

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.conflicts import (
    Accept,
    BenchConflictError,
    environment_differences,
    problem_differences,
    refused,
    setting_differences,
)
from phframe.bench.directory_lock import DirectoryLock
from phframe.bench.environment import Environment
from phframe.bench.limits import TrialLimits
from phframe.bench.outcome import result_of
from phframe.bench.pool import run_trials
from phframe.bench.store import ResultStore
from phframe.bench.surroundings import surroundings
from phframe.bench.trial import Trial
from phframe.bench.trial_process import METHOD, Ending
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import InputError

Scheduler = Callable[[Iterable[Trial], TrialLimits], Generator[tuple[Trial, Ending], None, None]]
"""Runs trials and tells how the process of each ended, in any order; closed, it ends those that run."""


@dataclass(frozen=True, slots=True)
class Selected:
    """A trial of a bench and what is known of it.

    Attributes:
        number: Of the trial in the plan.
        trial: The trial.
        result: Its result; None: it has not been run.
    """

    number: int
    trial: Trial
    result: TrialResult | None


class BenchSession:
    """A bench in a directory; use it in a ``with``. While it is open no other one can be at work there.

    Args:
        directory: Where; a bench that is there already goes on.
        plan: What is to be run.
        accepted: In what the bench that is there may differ from that.

    Attributes:
        store: The results.
        left_out: How many results that the bench had are kept, but no part of it any more.

    Raises:
        BenchConflictError: If the directory holds another bench.
        StoreError: If its file cannot be used, or another process is at work there.
    """

    def __init__(self, directory: Path, plan: BenchPlan, accepted: Collection[Accept] = ()) -> None:
        if METHOD not in multiprocessing.get_all_start_methods():
            raise InputError("a bench needs an operating system with fork servers, which Windows has none of: use WSL")
        self.plan, self._environment = plan, surroundings(plan.specs.values())
        directory.mkdir(parents=True, exist_ok=True)
        self._lock = DirectoryLock(directory)
        try:
            self.store, self.left_out = _store(directory, plan, self._environment, accepted)
        except BaseException:
            self._lock.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.store.close()
        self._lock.close()

    def run(self, numbers: Iterable[int], scheduler: Scheduler) -> Generator[TrialResult, None, None]:
        """Run trials; each result is told when it is stored. Close the iterator to end those that are running.

        Args:
            numbers: Of the trials in the plan. A result that one has already is replaced.
            scheduler: What runs them.
        """
        settings = self.plan.settings
        ids: dict[Environment | None, str] = {None: self.store.add_environment(self._environment)}
        limits = TrialLimits(settings.kill_after, settings.memory_limit)
        trials = (self.plan[number] for number in numbers)
        with closing(scheduler(trials, limits)) as endings:
            for trial, ending in endings:
                if ending.environment is not None and ending.environment not in ids:
                    ids[ending.environment] = self.store.add_environment(ending.environment)
                result, fault = result_of(trial, ending, limits, ids[ending.environment])
                self.store.add(result, fault=fault, replace=True)
                yield result

    def local(self, workers: int) -> Scheduler:
        """What runs trials on this machine.

        Args:
            workers: How many at once.
        """
        return lambda trials, limits: run_trials(trials, limits, workers, self.plan.modules)


def select_trials(plan: BenchPlan, store: ResultStore | None, wanted: str = "") -> Iterator[Selected]:
    """The trials of a bench and what is known of each, in the order in which they are run.

    Args:
        plan: The bench.
        store: Its results; None: there are none.
        wanted: Only those whose problem, planner, or, where they have been run, end or reason match this pattern; one
            without wildcards matches all that holds it. Empty: all.
    """
    for number, trial in enumerate(plan.trials()):
        result = None if store is None else store.result(trial.key)
        told = () if result is None else (str(result.end), result.reason)
        if matches(wanted, (trial.problem, trial.planner, *told)):
            yield Selected(number, trial, result)


def matches(wanted: str, texts: Iterable[str]) -> bool:
    """Whether one of some texts matches a pattern, as ``select_trials`` has it."""
    pattern = wanted if set(wanted) & set("*?") else f"*{wanted}*"
    return any(fnmatchcase(text, pattern.replace("[", "[[]")) for text in texts)


def to_run(selected: Iterable[Selected], *, retry: bool = False) -> list[int]:
    """Of some trials the numbers of those that are to be run: without a result, and for a retry those without an episode."""
    return [
        each.number for each in selected if each.result is None or (retry and each.result.end is not TrialEnd.FINISHED)
    ]


def _store(
    directory: Path, plan: BenchPlan, environment: Environment, accepted: Collection[Accept]
) -> tuple[ResultStore, int]:
    """The store in a directory, agreeing with a plan, and how many of its results no longer count; else a new one."""
    if not ResultStore.is_in(directory):
        return ResultStore.create(directory, plan.settings, plan.digests), 0
    store = ResultStore.open(directory, read_only=False)
    try:
        return store, _reconcile(store, directory, plan, environment, accepted)
    except BaseException:
        store.close()
        raise


def _reconcile(
    store: ResultStore, directory: Path, plan: BenchPlan, environment: Environment, accepted: Collection[Accept]
) -> int:
    """Have a store say what a plan does: how many of its results no longer count.

    Raises:
        BenchConflictError: If they differ in what is not accepted.
    """
    known = store.environments()
    differences = [
        *problem_differences(store.problems(), plan.digests),
        *setting_differences(store.settings, plan.settings),
    ]
    if known and environment.id not in known:
        differences += environment_differences(list(known.values())[-1], environment)
    if wrong := refused(differences, accepted):
        raise BenchConflictError(directory, wrong)
    return store.set_plan(plan.settings, (trial.key for trial in plan.trials()), plan.digests)
