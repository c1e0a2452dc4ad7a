"""Trials on a Dask cluster: nothing is lost and nothing done twice, whatever becomes of the workers."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.limits import TrialLimits
from phframe.bench.merge_conflicts import result_differences
from phframe.bench.outcome import result_of
from phframe.bench.schedulers.dask_ import ClusterError, cluster_scheduler, run_on_cluster
from phframe.bench.schedulers.on_worker import UnfitWorkerError, WorkerSpec, examine
from phframe.bench.session import BenchSession
from phframe.bench.settings import BenchSettings
from phframe.bench.store import ResultStore
from phframe.bench.trial import Trial
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import InputError, RunSpec
from phframe.runtime.run import prepare
from tests.bench.cluster.dask_cluster import VERSION, DaskCluster, dask_cluster, look

pytestmark = [pytest.mark.needs_cluster, pytest.mark.slow, pytest.mark.long]
pytest.importorskip("distributed")

LIMITS = TrialLimits(60.0, 4096)
MAY_START = {"DASK_DISTRIBUTED__WORKER__DAEMON": "False"}
PLANNERS = """
import multiprocessing, os, signal
from phframe.core import Options, Planner

class Exits(Planner[Options]):
    def search(self, task):
        os._exit(7)

class KillsItsWorker(Planner[Options]):
    def search(self, task):
        os.kill(multiprocessing.parent_process().pid, signal.SIGKILL)
"""


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaskCluster]:
    """A worker of each kind: without a nanny, and with one and the setting that lets it start processes."""
    with dask_cluster(tmp_path_factory.mktemp("cluster"), 1) as started:
        started.start_worker("--nanny", **MAY_START)
        yield started


@pytest.fixture
def planners(tmp_path: Path) -> Path:
    file = tmp_path / "planners.py"
    file.write_text(PLANNERS)
    return file


def trials(count: int, planner: str = "phia") -> list[Trial]:
    spec = prepare(RunSpec("vieira/simple-01", planner)).spec
    return [Trial("vieira", replace(spec, seed=seed)) for seed in range(count)]


def results_on(cluster: DaskCluster, wanted: Sequence[Trial]) -> Generator[TrialResult, None, None]:
    with closing(run_on_cluster(cluster.address, wanted, WorkerSpec.of(look, LIMITS))) as endings:
        for trial, ending in endings:
            yield result_of(trial, ending, LIMITS)[0]


def refusal(spec: WorkerSpec, told: Any) -> None:
    try:
        told.put(repr(examine(spec)))
    except UnfitWorkerError as error:
        told.put(str(error))


def stored(directory: Path) -> list[TrialResult]:
    with ResultStore.open(directory) as store:
        return list(store.results())


def test_a_bench_whose_worker_is_killed_ends_like_one_that_was_not_disturbed(tmp_path: Path) -> None:
    plan = BenchPlan.of(BenchSettings(("vieira/simple-0*",), ("phia", "ooa")))
    numbers = range(6)
    told: list[str] = []
    with dask_cluster(tmp_path, 2) as own, BenchSession(tmp_path / "cluster", plan) as session:
        for result in session.run(numbers, cluster_scheduler(own.address, plan)):
            told.append(result.key)
            if len(told) == 2:
                own.workers[0].send_signal(signal.SIGKILL)
    assert sorted(told) == sorted(plan[number].key for number in numbers)
    with BenchSession(tmp_path / "local", plan) as session:
        list(session.run(numbers, session.local(2)))
    pairs = list(zip(stored(tmp_path / "local"), stored(tmp_path / "cluster"), strict=True))
    assert len(pairs) == 6
    assert [list(result_differences(*pair)) for pair in pairs] == [[]] * 6


def test_a_trial_that_crashes_costs_itself_only(cluster: DaskCluster, planners: Path) -> None:
    wanted = [*trials(2), *trials(2, f"{planners}:Exits"), *trials(1, "ooa")]
    ends = {result.key: result.end for result in results_on(cluster, wanted)}
    expected = [TrialEnd.FINISHED] * 2 + [TrialEnd.CRASHED] * 2 + [TrialEnd.FINISHED]
    assert [ends[trial.key] for trial in wanted] == expected
    assert all(worker.poll() is None for worker in cluster.workers)


def test_where_there_is_no_worker_yet_that_is_told_once_and_the_trials_wait(tmp_path: Path) -> None:
    with dask_cluster(tmp_path, 0) as own:
        came: list[Any] = []
        spec = WorkerSpec.of(look, LIMITS)
        with closing(run_on_cluster(own.address, trials(2), spec, lambda: came.append(own.start_worker()))) as endings:
            assert len(list(endings)) == 2
        assert len(came) == 1


def test_who_stops_listening_leaves_the_cluster_free(cluster: DaskCluster) -> None:
    with closing(results_on(cluster, trials(500))) as ran:
        next(ran)
    (after,) = trials(1, "ooa")
    assert [result.key for result in results_on(cluster, [after])] == [after.key]


def test_workers_of_another_version_are_refused_at_once_and_when_they_come(cluster: DaskCluster) -> None:
    ran = results_on(cluster, trials(60))
    next(ran)
    stranger = cluster.start_worker("--no-nanny", **{VERSION: "2"})
    try:
        with pytest.raises(UnfitWorkerError, match="phframe is 2 there, 1 here"):
            list(ran)
        with pytest.raises(UnfitWorkerError, match=r"worker tcp://.* cannot run trials: it is not like this computer"):
            next(results_on(cluster, trials(1)))
    finally:
        stranger.kill()
        stranger.wait()


def test_a_worker_that_may_not_start_processes_is_refused_with_the_setting() -> None:
    context = multiprocessing.get_context("spawn")
    told = context.SimpleQueue()
    process = context.Process(target=refusal, args=(WorkerSpec.of(look, LIMITS), told), daemon=True)
    process.start()
    process.join()
    assert "DASK_DISTRIBUTED__WORKER__DAEMON=False" in told.get()
    told.close()


def test_a_trial_that_takes_its_workers_down_is_given_up_and_told(
    tmp_path: Path, planners: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", "0")
    monkeypatch.setattr("phframe.bench.schedulers.dask_.ATTEMPTS", 2)
    with dask_cluster(tmp_path, 0) as own:
        own.start_worker("--nanny", **MAY_START)
        with pytest.raises(ClusterError, match=r"1 trials have no result.* 2 times"):
            list(results_on(own, trials(1, f"{planners}:KillsItsWorker")))


def test_a_scheduler_that_goes_away_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("phframe.bench.schedulers.dask_.PATIENCE", 2.0)
    with dask_cluster(tmp_path, 0) as own:
        assert own.scheduler is not None
        wanted = iter(trials(3))

        def last_is_submitted() -> Iterator[Trial]:
            yield from wanted
            own.scheduler.kill()  # type: ignore[union-attr]

        with pytest.raises(ClusterError, match="start the bench again"):
            list(run_on_cluster(own.address, last_is_submitted(), WorkerSpec.of(look, LIMITS)))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://x:1", ""])
def test_an_address_without_a_scheduler_is_told(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("phframe.bench.schedulers.dask_.PATIENCE", 0.5)
    with pytest.raises(InputError, match="no Dask scheduler at"):
        next(run_on_cluster(address, trials(1), WorkerSpec.of(look, LIMITS)))
