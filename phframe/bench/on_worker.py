"""What a worker of a cluster does: see whether it is fit for trials, and run each in a process of its own."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib import metadata
from multiprocessing.connection import wait
from threading import Lock

from phframe.bench.environment import Environment
from phframe.bench.limits import TrialLimits
from phframe.bench.trial import Trial
from phframe.bench.trial_process import Ending, TrialProcess, preload
from phframe.core import PhframeError

_ALONE = Lock()
"""Held while a process is started or its exit code fetched: multiprocessing lets no two threads do so at once."""


class UnfitWorkerError(PhframeError):
    """A worker that cannot run the trials of this bench: other versions, or it may not start processes."""


@dataclass(frozen=True, slots=True)
class WorkerSpec:
    """What a worker has to be, and what all trials have in common. It is sent to the workers.

    Attributes:
        look: Finds out where it is called: versions, code, machine.
        here: What it finds where the bench runs.
        limits: At which a trial's process is ended.
        modules: What the processes of trials have imported from the beginning.
    """

    look: Callable[[], Environment]
    here: Environment
    limits: TrialLimits
    modules: tuple[str, ...] = ()

    @staticmethod
    def of(look: Callable[[], Environment], limits: TrialLimits, modules: Sequence[str] = ()) -> WorkerSpec:
        """For workers that are like this process."""
        return WorkerSpec(look, _seen(look), limits, tuple(modules))


def examine(spec: WorkerSpec) -> Environment:
    """Where this worker runs, if it is fit for trials.

    Raises:
        UnfitWorkerError: If it may not start processes, or its versions or code are not those of the bench.
    """
    if multiprocessing.current_process().daemon:
        raise UnfitWorkerError(
            "it may not start processes, and each trial needs one of its own: start workers with --no-nanny, or with "
            "DASK_DISTRIBUTED__WORKER__DAEMON=False in their environment"
        )
    there = _seen(spec.look)
    for what in ("versions", "code"):
        wanted, found = getattr(spec.here, what), getattr(there, what)
        other = [name for name in sorted(wanted.keys() | found.keys()) if wanted.get(name) != found.get(name)]
        if other:
            told = (f"{name} is {found.get(name, 'missing')}, here {wanted.get(name, 'missing')}" for name in other)
            raise UnfitWorkerError(f"its {what} differ: {'; '.join(told)}. Install the same on all")
    return there


def run_here(trial: Trial, spec: WorkerSpec) -> tuple[Ending, Environment]:
    """Run a trial in a process of its own on this worker: how it ended, and where.

    Raises:
        UnfitWorkerError: As ``examine``; the trial has not been started then.
    """
    environment = examine(spec)
    preload(spec.modules)
    process = TrialProcess(trial, spec.limits)
    try:
        with _ALONE:
            process.start()
        while not process.listen():
            wait(process.waitables, process.seconds_left)
        with _ALONE:
            return process.ending(), environment
    except BaseException:
        process.end()
        raise


def _seen(look: Callable[[], Environment]) -> Environment:
    """What is found here, and the version of what carries trials from process to process."""
    found = look()
    return replace(found, versions={**found.versions, "distributed": metadata.version("distributed")})
