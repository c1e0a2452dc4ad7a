"""Trials on a Dask cluster: nothing is lost and nothing done twice, whatever becomes of the workers."""

from __future__ import annotations

import signal
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.limits import TrialLimits
from phframe.bench.merge_conflicts import result_differences
from phframe.bench.outcome import result_of
from phframe.bench.schedulers.dask_ import ATTEMPTS, ClusterError, cluster_scheduler, run_on_cluster
from phframe.bench.schedulers.on_worker import UnfitWorkerError, WorkerSpec
from phframe.bench.session import BenchSession
from phframe.bench.settings import BenchSettings
from phframe.bench.store import ResultStore
from phframe.bench.trial import Trial
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import InputError, RunSpec
from phframe.runtime.run import prepare
from tests.bench.cluster.dask_cluster import VERSION, DaskCluster, dask_cluster, look

pytestmark = [pytest.mark.needs_cluster, pytest.mark.slow]
pytest.importorskip("distributed")

LIMITS = TrialLimits(60.0, 4096)
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
    with dask_cluster(tmp_path_factory.mktemp("cluster"), 2) as started:
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


def test_a_worker_that_may_not_start_processes_is_refused_with_the_setting(tmp_path: Path) -> None:
    with dask_cluster(tmp_path, 0) as own:
        own.start_worker("--nanny")
        with pytest.raises(UnfitWorkerError, match="DASK_DISTRIBUTED__WORKER__DAEMON=False"):
            next(results_on(own, trials(1)))
        own.workers[0].terminate()
        own.workers[0].wait(60)
        own.start_worker("--nanny", DASK_DISTRIBUTED__WORKER__DAEMON="False")
        assert len(list(results_on(own, trials(1)))) == 1


def test_a_trial_that_takes_its_workers_down_is_given_up_and_told(
    tmp_path: Path, planners: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", "0")
    with dask_cluster(tmp_path, ATTEMPTS) as own:
        with pytest.raises(ClusterError, match="1 trials have no result"):
            list(results_on(own, trials(1, f"{planners}:KillsItsWorker")))
        assert [worker.wait(20) for worker in own.workers] == [-signal.SIGKILL] * ATTEMPTS


def test_a_scheduler_that_goes_away_is_told(tmp_path: Path) -> None:
    with dask_cluster(tmp_path, 1) as own:
        ran = results_on(own, trials(60))
        next(ran)
        assert own.scheduler is not None
        own.scheduler.kill()
        with pytest.raises(ClusterError, match="start the bench again"):
            list(ran)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://x:1", ""])
def test_an_address_without_a_scheduler_is_told(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("phframe.bench.schedulers.dask_.PATIENCE", 0.5)
    with pytest.raises(InputError, match="no Dask scheduler at"):
        next(run_on_cluster(address, trials(1), WorkerSpec.of(look, LIMITS)))
