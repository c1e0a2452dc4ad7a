"""Trials on a Dask cluster: nothing is lost and nothing done twice, whatever becomes of the workers."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from phframe.bench.dask_ import ATTEMPTS, ClusterError, run_on_cluster
from phframe.bench.environment import Environment
from phframe.bench.limits import TrialLimits
from phframe.bench.merge_differences import result_differences
from phframe.bench.on_worker import WorkerSpec
from phframe.bench.outcome import result_of
from phframe.bench.pool import run_trials
from phframe.bench.trial import Trial
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import RunSpec
from phframe.runtime.run import prepare
from tests.bench.cluster.dask_cluster import DaskCluster, dask_cluster, look

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


def results_on(cluster: DaskCluster, wanted: Sequence[Trial]) -> Iterator[tuple[TrialResult, Environment]]:
    """What comes of trials, and where each ran."""
    for trial, ending, environment in run_on_cluster(cluster.address, wanted, WorkerSpec.of(look, LIMITS)):
        yield result_of(trial, ending, LIMITS)[0], environment


def test_a_killed_worker_costs_no_trial_and_none_is_told_twice(tmp_path: Path) -> None:
    wanted, ran = trials(8), []
    with dask_cluster(tmp_path, 2) as own:
        for result, environment in results_on(own, wanted):
            ran.append((result, environment.cpu))
            if len(ran) == 2:
                own.workers[0].send_signal(signal.SIGKILL)
    assert sorted(result.key for result, _ in ran) == sorted(trial.key for trial in wanted)
    assert {worker for _, worker in ran[4:]} == {str(own.workers[1].pid)}
    local = {trial.key: result_of(trial, ending, LIMITS)[0] for trial, ending in run_trials(wanted, LIMITS, 2)}
    assert [list(result_differences(local[result.key], result)) for result, _ in ran] == [[]] * 8


def test_a_trial_that_crashes_costs_itself_only(cluster: DaskCluster, planners: Path) -> None:
    wanted = [*trials(2), *trials(2, f"{planners}:Exits"), *trials(1, "ooa")]
    ends = {result.key: result.end for result, _ in results_on(cluster, wanted)}
    expected = [TrialEnd.FINISHED] * 2 + [TrialEnd.CRASHED] * 2 + [TrialEnd.FINISHED]
    assert [ends[trial.key] for trial in wanted] == expected
    assert all(worker.poll() is None for worker in cluster.workers)


def test_who_stops_listening_leaves_the_cluster_free(cluster: DaskCluster) -> None:
    ran = results_on(cluster, trials(500))
    next(ran)
    ran.close()
    (after,) = trials(1, "ooa")
    assert [result.key for result, _ in results_on(cluster, [after])] == [after.key]


def test_workers_of_another_version_are_refused_at_once_and_when_they_come(cluster: DaskCluster) -> None:
    ran = results_on(cluster, trials(60))
    next(ran)
    stranger = cluster.start_worker("--no-nanny", **{VERSION: "2"})
    try:
        with pytest.raises(UnfitWorkerError, match="versions differ: phframe is 2, here 1"):
            list(ran)
        with pytest.raises(UnfitWorkerError, match=r"worker tcp://.* cannot run trials: its versions differ"):
            next(results_on(cluster, trials(1)))
    finally:
        stranger.kill()
        stranger.wait()


def test_a_worker_that_may_not_start_processes_is_refused_with_the_setting(tmp_path: Path) -> None:
    with dask_cluster(tmp_path, 0) as own:
        own.start_worker("--nanny")
        with pytest.raises(UnfitWorkerError, match="DASK_DISTRIBUTED__WORKER__DAEMON=False"):
            next(results_on(own, trials(1)))
        own.workers.pop().terminate()
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
    monkeypatch.setattr("phframe.bench.dask_.PATIENCE", 0.5)
    with pytest.raises(InputError, match="no Dask scheduler at"):
        next(run_on_cluster(address, trials(1), WorkerSpec.of(look, LIMITS)))
