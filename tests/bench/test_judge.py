"""What a trial measures, and that what its process sends is not taken on trust."""

from __future__ import annotations

import json
from copy import deepcopy
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.guarded_planner import GuardedPlanner
from phframe.bench.judge import carry_out, measured
from phframe.bench.limits import TrialLimits
from phframe.bench.outcome import result_of
from phframe.bench.summary import summary
from phframe.bench.trial_process import Ending
from phframe.bench.trial_result import TrialEnd
from phframe.core import Episode, Loop, Plan, Planner, RunSpec, Status, Task
from phframe.core.errors import BudgetExceededError
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.runtime.run import run
from tests.bench.benches import a_result, settings

LIMITS = TrialLimits(60.0, 4096)
TRIAL = BenchPlan.of(settings())[0]


@pytest.fixture(scope="module")
def episode() -> Episode:
    return run(RunSpec("vieira/simple-01"))


def ending(message: Any = b"", code: int = 0, output: str = "", *, overdue: bool = False) -> Ending:
    content = message if isinstance(message, bytes) else json.dumps(message).encode()
    return Ending(code, overdue, content, output, 1.5, "2026-01-01T00:00:00Z")


def test_an_episode_is_measured(episode: Episode) -> None:
    found = measured(episode)
    moved = [
        sum((after - before) ** 2 for after, before in zip(end[:3], start[:3], strict=True)) ** 0.5
        for name, end, start in zip(
            episode.scene.ids,
            episode.final_state.poses.tolist(),
            episode.scene.initial_state().poses.tolist(),
            strict=True,
        )
        if name != episode.scene.target
    ]
    assert found["displacement"] == pytest.approx(sum(moved))
    assert found["largest_displacement"] == pytest.approx(max(moved))
    assert max(moved) > 0.01
    assert found["deviations"] == episode.deviations
    assert {type(name) for name in found["deviations"]} <= {str}
    assert found["pushes"] == len(episode.steps) - 1 == 2
    assert found["largest_force"] == max(step.motion.largest_force for step in episode.steps)
    assert (found["claimed"], found["status"], found["retrieved"], found["clean"]) == (
        "retrieved",
        "retrieved",
        True,
        True,
    )


class LateOffers(Planner[PHIAOptions]):
    """Offers what is not worth carrying out, then what is, then lets the budget run out."""

    options_type = PHIAOptions

    def search(self, task: Task) -> Plan:
        task.offer(Plan(Status.FAILED, "not yet"))
        assert task.first_solution_time is None
        task.offer(PHIA(self.options).search(task))
        first = task.first_solution_time
        task.offer(PHIA(self.options).search(task))
        assert first == task.first_solution_time
        raise BudgetExceededError("over")


def test_the_first_plan_that_was_worth_carrying_out_is_timed() -> None:
    planner = GuardedPlanner(LateOffers(PHIAOptions()))
    found = run(RunSpec("vieira/simple-01", planner=planner))
    assert found.status is Status.RETRIEVED
    assert 0 < (planner.first_solution_time or 0) < found.plans[0].cost.total
    assert carry_out(RunSpec("vieira/simple-01"))["first_solution_time"] > 0


def test_watching_a_planner_is_no_planning_time(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]

    def slow_copy(value: Any) -> Any:
        clock[0] += 1000.0
        return deepcopy(value)

    monkeypatch.setattr("phframe.core.task.time", SimpleNamespace(perf_counter=lambda: clock[0]))
    monkeypatch.setattr("phframe.bench.guarded_planner.deepcopy", slow_copy)
    planner = GuardedPlanner(PHIA(PHIAOptions()))
    found = run(RunSpec("vieira/simple-01", planner=planner))
    assert clock[0] >= 5000.0
    assert (found.status, found.cost.total, planner.first_solution_time) == (Status.RETRIEVED, 0.0, 0.0)


def test_where_there_was_no_plan_there_is_no_time_of_the_first() -> None:
    found = carry_out(RunSpec("vieira/simple-01", loop=Loop(simulations=0)))
    assert (found["first_solution_time"], found["claimed"], found["retrieved"]) == (None, "timeout", False)


def test_what_was_measured_is_the_result(episode: Episode) -> None:
    content = {"end": "finished", **measured(episode)}
    result, fault = result_of(TRIAL, ending(content, output="hello"), LIMITS, "here")
    assert fault == ""
    assert {name: getattr(result, name) for name in content} == content
    assert (result.key, result.planner, result.environment) == (TRIAL.key, "phia", "here")
    assert RunSpec.from_json(result.spec).key() == result.key


LIES: list[dict[str, Any]] = [
    {"retrieved": True, "status": "failed"},
    {"retrieved": False},
    {"status": "failed", "retrieved": False, "clean": True},
    {"status": "splendid"},
    {"claimed": "splendid"},
    {"pushes": -1},
    {"planning_time": float("nan")},
    {"planning_time": float("inf")},
    {"pushes": "many"},
    {"end": "error"},
    {"reason": "x" * 10_000},
    {"deviations": 3},
]


@pytest.mark.parametrize("lie", LIES, ids=str)
def test_a_result_that_contradicts_itself_is_an_error(episode: Episode, lie: dict[str, Any]) -> None:
    result, _ = result_of(TRIAL, ending({"end": "finished", **measured(episode), **lie}), LIMITS)
    assert (result.end, result.retrieved) == (TrialEnd.ERROR, False)
    assert result.reason.startswith("what it sent is no result: ")


def test_a_trial_has_no_say_in_what_the_bench_knows(episode: Episode) -> None:
    content = {"end": "finished", **measured(episode), "key": "mine", "wall_time": 0.0, "planner": "best", "unheard": 1}
    result, _ = result_of(TRIAL, ending(content), LIMITS)
    assert (result.key, result.wall_time, result.planner) == (TRIAL.key, 1.5, "phia")


@given(st.binary() | st.recursive(st.none() | st.integers() | st.text(), lambda x: st.dictionaries(st.text(), x)).map(
    lambda value: json.dumps(value).encode()
))  # fmt: skip
def test_whatever_it_sends_there_is_a_result(message: bytes) -> None:
    result, _ = result_of(TRIAL, ending(message), LIMITS)
    assert result.end is TrialEnd.CRASHED


@pytest.mark.parametrize("output", ["terminate called after throwing an instance of 'std::bad_alloc'", "MemoryError"])
def test_an_engine_that_aborts_for_want_of_memory_ran_out_of_it(output: str) -> None:
    result, fault = result_of(TRIAL, ending(code=-6, output=output), LIMITS)
    assert (result.end, fault) == (TrialEnd.MEMORY, output)


def test_a_result_sent_by_a_process_that_then_died_does_not_count(episode: Episode) -> None:
    result, _ = result_of(TRIAL, ending({"end": "finished", **measured(episode)}, code=-11), LIMITS)
    assert result.end is TrialEnd.CRASHED


def test_the_summary_counts_by_planner_and_suite_with_the_wilson_interval() -> None:
    got = {"retrieved": True, "clean": True, "planning_time": 3.0}
    results = [a_result(str(n), pushes=n, **got) for n in range(8)]
    results += [a_result("f", planning_time=9.0), a_result("c", end=TrialEnd.CRASHED, planning_time=99.0)]
    results += [replace(results[0], suite="other", retrieved=False)]
    other, line = summary(results)
    assert (line.planner, line.suite, line.trials, line.retrieved, line.clean, line.failures) == (
        "phia",
        "s",
        10,
        8,
        8,
        1,
    )
    assert (line.low, line.high) == pytest.approx((0.490162, 0.943318), abs=1e-6)  # Wilson 1927, by hand
    assert (line.pushes, line.planning_time) == (3.5, 3.0)
    assert (other.retrieved, other.pushes, other.low) == (0, None, 0.0)


def test_seeds_that_agree_narrow_no_interval_of_the_summary() -> None:
    results = [a_result(f"s/{n}", problem=f"s/{n}", retrieved=n < 6) for n in range(8)]
    (once,) = summary(results)
    (often,) = summary([replace(each, key=f"{each.key}-{seed}", seed=seed) for each in results for seed in range(10)])
    assert (once.trials, once.retrieved, often.trials, often.retrieved) == (8, 6, 80, 60)
    assert (often.low, often.high) == pytest.approx((once.low, once.high))
