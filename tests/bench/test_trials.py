"""Trials in processes of their own: whatever one does costs it alone, and is told as what it was."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

import pytest

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.judge import measured
from phframe.bench.session import BenchSession
from phframe.bench.store import ResultStore
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import Loop, RunSpec
from phframe.runtime.run import run
from tests.bench.benches import lives, misbehaving, noted, run_all, settings, until

pytestmark = [pytest.mark.slow, pytest.mark.long]

CRASHED, ERROR, FINISHED = TrialEnd.CRASHED, TrialEnd.ERROR, TrialEnd.FINISHED
ENDS: Mapping[str, tuple[TrialEnd, str]] = {
    "Segfaults": (CRASHED, "was ended by signal 11 (Segmentation fault) in File "),
    "Aborts": (CRASHED, "was ended by signal 6 (Aborted) in File "),
    "Exits": (CRASHED, "ended with exit code 3 before there was a result; the last it said: I have had enough"),
    "ExitsAsIfAllWereWell": (CRASHED, "ended with exit code 0 before there was a result"),
    "AsksToExit": (ERROR, "asked to exit, with 4"),
    "Hangs": (TrialEnd.KILLED, "it ran longer than 20 s and was killed"),
    "EatsMemory": (TrialEnd.MEMORY, "it asked for more memory than it may have"),
    "ReturnsThree": (ERROR, "planner ReturnsThree returned 3 instead of a Plan"),
    "ReturnsNonsense": (ERROR, "AttributeError"),
    "Raises": (ERROR, "RuntimeError: no idea (line "),
    "Interrupts": (ERROR, "KeyboardInterrupt"),
    "MovesTheStart": (ERROR, "planner MovesTheStart changed what it was given: start"),
    "ChangesTheScene": (ERROR, "planner ChangesTheScene changed what it was given: scene"),
    "Prints": (FINISHED, ""),
    "ClosesItsOutput": (FINISHED, ""),
    "Forks": (FINISHED, ""),
    "ForksAndReturnsTwice": (FINISHED, ""),
    "Decent": (FINISHED, ""),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("bench")


@pytest.fixture(scope="module")
def results(folder: Path) -> Mapping[str, TrialResult]:
    """Of all planners that misbehave, in one bench, beside PHIA."""
    names = [f"{misbehaving(name)}[mark={folder / name}]" for name in ENDS]
    wanted = settings(planners=("phia", *names), loop=Loop(time_limit=60), trial_limit=20.0, memory_limit=1500)
    found = run_all(folder, wanted)
    return {result.planner.rpartition(":")[2].partition("[")[0]: result for result in found}


@pytest.mark.parametrize("name", ENDS)
def test_whatever_a_planner_does_is_its_own_trials_end(results: Mapping[str, TrialResult], name: str) -> None:
    end, reason = ENDS[name]
    result = results[name]
    assert (result.end, result.reason) == (end, result.reason if reason in result.reason else reason)
    assert "\n" not in result.reason
    assert bool(result.status) is (end is FINISHED)


def test_the_others_are_as_if_they_ran_alone(results: Mapping[str, TrialResult]) -> None:
    alone = measured(run(RunSpec("vieira/simple-01")))
    for name in ("phia", *(name for name, (end, _) in ENDS.items() if end is FINISHED)):
        assert {key: getattr(results[name], key) for key in alone if not is_wall_time(key)} == {
            key: value for key, value in alone.items() if not is_wall_time(key)
        }


def test_every_measure_is_there(results: Mapping[str, TrialResult]) -> None:
    phia = results["phia"]
    left = {each.name for each in fields(phia) if getattr(phia, each.name) in ("", 0, 0.0, None, False)}
    usual = {"seed", "reason", "replans", "rejections", "toppled", "spilled", "wall_contact", "motion_planning_time"}
    exact = {
        "prediction_error",
        "largest_prediction_error",
        "tracking_error",
        "target_moved",
    }  # planned in the same engine
    assert left <= usual | exact
    assert 0 < (phia.first_solution_time or 0) <= phia.planning_time < phia.wall_time
    assert 2**24 < phia.peak_memory < 1500 * 2**20


def test_all_is_stored_with_what_helps_to_find_out_why(results: Mapping[str, TrialResult], folder: Path) -> None:
    with ResultStore.open(folder) as store:
        assert sorted(each.key for each in store.results()) == sorted(each.key for each in results.values())
        assert {each.environment for each in store.results()} == set(store.environments())
        for name, (end, _) in ENDS.items():
            fault = store.fault(results[name].key)
            assert bool(fault) is (end is not FINISHED and name not in ("ExitsAsIfAllWereWell", "Hangs")), name
        assert "in search" in store.fault(results["Segfaults"].key)
        assert 'raise RuntimeError("no\\nidea")' in store.fault(results["Raises"].key)


@pytest.mark.usefixtures("results")
def test_what_a_planner_has_started_ends_with_its_trial(folder: Path) -> None:
    assert len(noted(folder / "Forks")) == 2
    assert [each for each in noted(folder / "Forks") if lives(each)] == []


def test_what_failed_is_run_again_if_asked_and_takes_its_place(tmp_path: Path) -> None:
    wanted = settings(planners=("phia", misbehaving("Exits")))
    assert len(run_all(tmp_path, wanted)) == 2
    assert run_all(tmp_path, wanted) == []
    (again,) = run_all(tmp_path, wanted, retry=True)
    assert again.end is CRASHED
    with ResultStore.open(tmp_path) as store:
        assert again in list(store.results())
        assert len(list(store.results())) == 2


def test_a_bench_that_is_not_run_to_its_end_leaves_no_process(tmp_path: Path) -> None:
    names = ("phia", f"{misbehaving('ForksAndHangs')}[mark={tmp_path / 'ids'}]")
    with BenchSession(tmp_path, BenchPlan.of(settings(planners=names))) as session:
        results = session.run(range(2), session.local(2))
        assert next(results).planner == "phia"
        until(lambda: len(noted(tmp_path / "ids")) == 3)
        results.close()
    until(lambda: not [each for each in noted(tmp_path / "ids") if lives(each)])


def is_wall_time(name: str) -> bool:
    return name in ("planning_time", "topology_time", "simulation_time", "motion_planning_time")
