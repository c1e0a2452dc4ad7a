"""Runs trials on the workers of a Dask cluster, each in a process of its own there."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import closing, suppress
from functools import partial
from itertools import islice
from typing import Any
from uuid import uuid4

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.schedulers.on_worker import UnfitWorkerError, WorkerSpec, examine, run_here
from phframe.bench.session import Scheduler
from phframe.bench.surroundings import surroundings
from phframe.bench.trial import Trial
from phframe.bench.trial_process import Ending
from phframe.core import InputError, NotInstalledError, PhframeError

AHEAD = 1000
"""Trials that the scheduler knows of at a time; a cluster that grows with its work sees that there is some."""
ATTEMPTS = 3
"""How often a trial is handed in. Each time Dask itself runs it again when its worker dies, ``allowed-failures`` times."""
PATIENCE = 30.0
"""Seconds to wait for the scheduler."""


class ClusterError(PhframeError):
    """A cluster that lost trials: they have no result and are run when the bench is started again."""


def check_address(address: str) -> None:
    """Refuse what is no address of a scheduler: Dask would start a cluster here, or try for ever to reach it.

    Raises:
        NotInstalledError: If Dask is not installed.
        InputError: If it is none.
    """
    try:
        from distributed.comm.addressing import get_address_host_port
    except ImportError as error:
        raise _not_installed() from error
    try:
        host, port = get_address_host_port(address)
        if not host or not 0 < port < 2**16:
            raise ValueError(f"{host}:{port} is none of a computer and a port")
    except (ValueError, TypeError, NotImplementedError) as error:
        raise _no_scheduler(address, error) from None


def cluster_scheduler(address: str, plan: BenchPlan, waits: Callable[[], object] = lambda: None) -> Scheduler:
    """What runs the trials of a bench on the workers of a cluster.

    Args:
        address: Of its scheduler.
        plan: The bench.
        waits: Called if the cluster has no worker yet.
    """
    look = partial(surroundings, tuple(plan.specs.values()))
    return lambda trials, limits: run_on_cluster(address, trials, WorkerSpec.of(look, limits, plan.modules), waits)


def run_on_cluster(
    address: str, trials: Iterable[Trial], spec: WorkerSpec, waits: Callable[[], object] = lambda: None
) -> Generator[tuple[Trial, Ending], None, None]:
    """Run trials and tell of each as it ends, and where. Close the iterator to take back those that wait.

    A worker may die at any moment: what it was at is run on another one. Workers may come at any moment.

    Args:
        address: Of the scheduler, such as ``tcp://10.0.0.1:8786``.
        trials: The trials; each is taken when the scheduler gets it.
        spec: What the workers have to be.
        waits: Called if there is no worker yet; the trials wait for one.

    Raises:
        NotInstalledError: If Dask is not installed.
        InputError: If there is no scheduler at the address.
        UnfitWorkerError: If a worker differs from this process, or may not start processes.
        ClusterError: At the end, if there are trials whose workers died each time; or if the scheduler is lost.
    """
    with closing(_connected(address)) as client:
        if not client.scheduler_info()["workers"]:
            waits()
        _examine_all(client, spec)
        yield from _Submission(client, spec).run(iter(trials))


class _Submission:
    """Trials that the scheduler has."""

    def __init__(self, client: Any, spec: WorkerSpec) -> None:
        from distributed import as_completed

        self._client = client
        self._spec = spec
        self._ended = as_completed(loop=client.loop)
        self._trials: dict[str, Trial] = {}
        self._deaths: Counter[str] = Counter()
        self._name = f"phframe-{uuid4().hex[:12]}"
        self._count = 0

    def run(self, waiting: Iterator[Trial]) -> Iterator[tuple[Trial, Ending]]:
        """Submit trials as others end, and tell of each."""
        lost = 0
        try:
            self._submit(islice(waiting, AHEAD))
            for future in self._ended:
                trial = self._trials.pop(future.key)
                if (ending := self._ending(future)) is not None:
                    yield trial, ending
                elif self._may_try_again(trial):
                    self._submit([trial])
                else:
                    lost += 1
                self._submit(islice(waiting, 1))
        finally:
            with suppress(Exception):
                self._client.cancel(self._ended.futures, force=True)
        if lost:
            raise ClusterError(
                f"{lost} trials have no result: every worker that ran one died, {ATTEMPTS} times and more. Look into the "
                "workers' logs, and start the bench again to run them"
            )

    def _submit(self, trials: Iterable[Trial]) -> None:
        for trial in trials:
            self._count += 1
            key = f"{self._name}-{self._count}"
            self._trials[key] = trial
            self._ended.add(self._client.submit(run_here, trial, self._spec, key=key, pure=False, retries=0))

    def _ending(self, future: Any) -> Ending | None:
        """How a trial ended; None: its workers died.

        Raises:
            UnfitWorkerError: If the worker refused it.
            ClusterError: If it is lost in another way.
        """
        from distributed import KilledWorker

        if future.status == "finished":
            ending: Ending = future.result()
            return ending
        error = future.exception() if future.status == "error" else None
        if isinstance(error, KilledWorker):
            return None
        if isinstance(error, PhframeError):
            raise UnfitWorkerError(f"a worker refuses trials: {error}") from None
        what = f"{type(error).__name__}: {error}" if error else "the scheduler was lost or has dropped the trials"
        raise ClusterError(f"the cluster failed: {what}. Results so far are kept; start the bench again to go on")

    def _may_try_again(self, trial: Trial) -> bool:
        self._deaths[trial.key] += 1
        return self._deaths[trial.key] < ATTEMPTS


def _connected(address: str) -> Any:
    """A client of the scheduler.

    Raises:
        NotInstalledError: If Dask is not installed.
        InputError: If it is no address, or none answers there.
    """
    check_address(address)
    from distributed import Client

    try:
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise _no_scheduler(address, error) from None


def _not_installed() -> NotInstalledError:
    return NotInstalledError("a bench on a cluster", "distributed", 'pip install "phframe[cluster]"')


def _no_scheduler(address: str, error: Exception) -> InputError:
    why = " ".join(str(error).split()) or "it does not answer"
    return InputError(
        f"no Dask scheduler at {address!r}: {why}. Give the address that it tells when it starts, such as "
        "tcp://10.0.0.1:8786"
    )


def _examine_all(client: Any, spec: WorkerSpec) -> None:
    """Look at the workers that are there, before anything runs.

    Raises:
        UnfitWorkerError: If one is not fit for the trials.
    """
    for worker, found in sorted(client.run(examine, spec, on_error="return").items()):
        if isinstance(found, Exception):
            why = str(found) if isinstance(found, PhframeError) else f"{type(found).__name__}: {found}"
            raise UnfitWorkerError(f"the worker {worker} cannot run trials: {why}")
