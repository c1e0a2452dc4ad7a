"""What a worker of a cluster does: see whether it is fit for trials, and run each in a process of its own."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import metadata
from multiprocessing.connection import wait
from threading import Lock

from phframe.bench.environment import Environment
from phframe.bench.limits import TrialLimits
from phframe.bench.trial import Trial
from phframe.bench.trial_process import Ending, TrialProcess, preload
from phframe.core import PhframeError

DASK = "distributed"
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
        dask: The version of ``distributed`` there, which carries trials from process to process.
        limits: At which a trial's process is ended.
        modules: What the processes of trials have imported from the beginning.
    """

    look: Callable[[], Environment]
    here: Environment
    dask: str
    limits: TrialLimits
    modules: tuple[str, ...] = ()

    @staticmethod
    def of(look: Callable[[], Environment], limits: TrialLimits, modules: Sequence[str] = ()) -> WorkerSpec:
        """For workers that are like this process."""
        return WorkerSpec(look, look(), metadata.version(DASK), limits, tuple(modules))


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
    there, dask = spec.look(), metadata.version(DASK)
    differing = [
        *_differing({**spec.here.versions, DASK: spec.dask}, {**there.versions, DASK: dask}),
        *_differing(spec.here.code, there.code, "the code of "),
    ]
    if differing:
        raise UnfitWorkerError(f"it is not like this computer: {'; '.join(differing)}. Install the same on all")
    return there


def run_here(trial: Trial, spec: WorkerSpec) -> Ending:
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
            return replace(process.ending(), environment=environment)
    except BaseException:
        process.end()
        raise


def _differing(wanted: Mapping[str, str], found: Mapping[str, str], what: str = "") -> Iterator[str]:
    for name in sorted(wanted.keys() | found.keys()):
        there, here = (each.get(name, "missing") for each in (found, wanted))
        if there != here:
            yield f"{what}{name} is {there} there, {here} here"
