"""Runs trials, a few at a time, each in a process of its own."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from itertools import islice
from multiprocessing.connection import wait

from phframe.bench.limits import TrialLimits
from phframe.bench.trial import Trial
from phframe.bench.trial_process import Ending, TrialProcess, preload


def run_trials(
    trials: Iterable[Trial], limits: TrialLimits, workers: int = 1, modules: Iterable[str] = ()
) -> Generator[tuple[Trial, Ending], None, None]:
    """Run trials and tell of each as it ends. Close the iterator to end those that are running.

    Args:
        trials: The trials; each is taken when there is a process for it.
        limits: At which a trial's process is ended.
        workers: How many run at once.
        modules: What their processes have imported from the beginning.

    Raises:
        InputError: If the system gives no process.
    """
    running: list[TrialProcess] = []
    waiting = iter(trials)
    preload(modules)
    try:
        while True:
            _fill(running, waiting, workers, limits)
            if not running:
                return
            for ended in _ended(running):
                running.remove(ended)
                yield ended.trial, ended.ending()
    finally:
        for process in running:
            process.end()


def _fill(running: list[TrialProcess], waiting: Iterator[Trial], workers: int, limits: TrialLimits) -> None:
    """Start trials until as many run as may."""
    for trial in islice(waiting, workers - len(running)):
        running.append(TrialProcess(trial, limits))  # before it starts: who ends all must know of it
        running[-1].start()


def _ended(running: list[TrialProcess]) -> list[TrialProcess]:
    """Wait until something happens; those that have ended then."""
    wait([each for process in running for each in process.waitables], min(each.seconds_left for each in running))
    return [process for process in running if process.listen()]
