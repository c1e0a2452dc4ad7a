"""A small bench for the tests of ``phframe bench``, and what is stored of one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from phframe.bench.store import ResultStore

SMALL = ("bench", "vieira/simple-0[123]", "--planner", "phia", "--planner", "ooa")
HERE = ("--out", "here")
TIMES = {
    "planning_time",
    "topology_time",
    "simulation_time",
    "motion_planning_time",
    "first_solution_time",
    "wall_time",
}
OWN = {"started", "peak_memory", "environment"}
"""Of one run alone."""


def rows(directory: Path | str) -> list[dict[str, Any]]:
    """All results, without what differs from run to run."""
    with ResultStore.open(directory) as store:
        results = list(store.results())
    names = [name for name in type(results[0]).__slots__ if name not in TIMES | OWN]
    return [{name: getattr(result, name) for name in names} for result in results]


def done(directory: str) -> int:
    """How many trials have a result."""
    if not ResultStore.is_in(directory):
        return 0
    with ResultStore.open(directory) as store:
        return len(store.done())
