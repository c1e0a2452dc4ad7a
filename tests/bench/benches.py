"""Small benches for the tests."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.session import BenchSession, select_trials, to_run
from phframe.bench.settings import BenchSettings
from phframe.bench.trial_result import TrialEnd, TrialResult

MISBEHAVING = Path(__file__).with_name("misbehaving.py")


def misbehaving(name: str) -> str:
    """A planner of that file."""
    return f"{MISBEHAVING}:{name}"


def settings(*suites: str, **others: Any) -> BenchSettings:
    """Settings, of one tiny problem if none is given."""
    return BenchSettings(suites or ("vieira/simple-01",), **others)


def run_all(directory: Path, wanted: BenchSettings, *, retry: bool = False) -> list[TrialResult]:
    """Run a bench to its end; what was run."""
    with BenchSession(directory, BenchPlan.of(wanted)) as session:
        numbers = to_run(select_trials(session.plan, session.store), retry=retry)
        return list(session.run(numbers, session.local(2)))


def noted(file: Path) -> list[int]:
    """The ids of processes that planners have left in a file."""
    return [int(line) for line in file.read_text().split()] if file.exists() else []


def lives(process: int) -> bool:
    """Whether a process is there, and not merely waiting to be reaped."""
    try:
        text = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return text.rpartition(")")[2].split()[0] != "Z"


def until(happened: Callable[[], object]) -> None:
    """Wait for something that must happen, however slow the machine; a minute is for what never does."""
    for _ in range(6000):
        if happened():
            return
        time.sleep(0.01)
    raise AssertionError("it did not happen")


def a_result(key: str = "k", **others: Any) -> TrialResult:
    """Some result."""
    known: dict[str, Any] = {"suite": "s", "problem": "s/1", "planner": "phia", "seed": 0, "end": TrialEnd.FINISHED}
    parts = dict.fromkeys(("backend", "arm", "plan_backend", "plan_arm"), "x")
    return TrialResult(**{"key": key, "spec": "{}", **known, **parts, **others})
