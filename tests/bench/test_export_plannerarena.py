"""The database is what Planner Arena reads: its tables, types and keys, and OMPL's values of the status."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from phframe.bench.environment import Environment
from phframe.bench.export.content import ExportContent
from phframe.bench.export.plannerarena import OmplStatus, ompl_status, write_plannerarena
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import InputError
from tests.bench.synthetic import ENVIRONMENT, SETTINGS, hostile_result, synthetic_result, synthetic_results

FIXED = [
    "id",
    "name",
    "totaltime",
    "timelimit",
    "memorylimit",
    "runcount",
    "version",
    "hostname",
    "cpuinfo",
    "date",
    "seed",
    "setup",
]


def exported(path: Path, results: Iterable[TrialResult], **environments: Environment) -> sqlite3.Connection:
    path.touch()
    write_plannerarena(ExportContent(results, SETTINGS, {ENVIRONMENT.id: ENVIRONMENT, **environments}), path)
    return sqlite3.connect(path)


def columns(database: sqlite3.Connection, table: str) -> list[tuple[str, str]]:
    return [(name, kind) for _, name, kind, *_ in database.execute(f"PRAGMA table_info({table})")]


def rows(database: sqlite3.Connection, query: str) -> list[tuple[Any, ...]]:
    return database.execute(query).fetchall()


@pytest.mark.parametrize("count", [1, 900])
def test_the_tables_are_planner_arenas(tmp_path: Path, count: int) -> None:
    with closing(exported(tmp_path / "a.db", synthetic_results(count))) as database:
        assert [name for name, _ in columns(database, "experiments")[:12]] == FIXED
        assert [kind for _, kind in columns(database, "experiments")[12:]] == ["TEXT"] * 5
        assert [name for name, _ in columns(database, "plannerConfigs")] == ["id", "name", "settings"]
        assert [name for name, _ in columns(database, "enums")] == ["name", "value", "description"]
        runs = columns(database, "runs")
        assert [name for name, _ in runs[:4]] == ["id", "experimentid", "plannerid", "status"]
        assert {kind for _, kind in runs} == {"INTEGER", "REAL", "BOOLEAN", "ENUM"}
        assert [name for name, kind in runs if kind == "ENUM"] == ["status"]
        assert ("retrieved", "BOOLEAN") in runs
        assert ("time", "REAL") in runs
        assert [name for name, _ in columns(database, "progress")] == ["runid", "time"]
        assert rows(database, "SELECT count(*) FROM runs") == [(count,)]
        assert rows(database, "PRAGMA foreign_key_check") == []
        assert rows(database, "PRAGMA integrity_check") == [("ok",)]
        keyed = rows(database, "SELECT name FROM sqlite_master WHERE sql LIKE '%PRIMARY KEY AUTOINCREMENT%' ORDER BY 1")
        assert [name for (name,) in keyed] == ["experiments", "plannerConfigs", "runs"]


def test_the_one_enum_is_ompls_status(tmp_path: Path) -> None:
    with closing(exported(tmp_path / "a.db", synthetic_results(1))) as database:
        assert rows(database, "SELECT * FROM enums ORDER BY value") == [
            ("status", value, name)
            for value, name in enumerate(
                [
                    "UNKNOWN",
                    "INVALID_START",
                    "INVALID_GOAL",
                    "UNRECOGNIZED_GOAL_TYPE",
                    "TIMEOUT",
                    "APPROXIMATE_SOLUTION",
                    "EXACT_SOLUTION",
                    "CRASH",
                    "ABORT",
                    "INFEASIBLE",
                ]
            )
        ]


def test_an_experiment_is_a_problem_in_an_environment_with_its_own_sums(tmp_path: Path) -> None:
    here = [replace(each, problem="vieira/basic", wall_time=2.0) for each in synthetic_results(6)]
    other = Environment({"phframe": "0.2.0"})
    there = replace(here[0], environment=other.id)
    with closing(exported(tmp_path / "a.db", [*here, there], **{other.id: other})) as database:
        found = rows(database, "SELECT name, totaltime, timelimit, memorylimit, runcount, version FROM experiments")
        assert found == [
            ("vieira/basic", 12.0, 30.0, 4096.0, 2, "phframe 0.1.0 0123abc"),
            ("vieira/basic", 2.0, 30.0, 4096.0, 1, "phframe 0.2.0"),
        ]
        named = rows(database, "SELECT name, settings FROM plannerConfigs")
        assert named == [("phia", ""), ("phia[sweeps=paper]", "sweeps=paper"), ("ooa", ""), ("random", "")]
        joined = "SELECT c.name, r.time, r.memory FROM runs r JOIN plannerConfigs c ON c.id = r.plannerid ORDER BY r.id"
        assert rows(database, joined) == [
            (each.planner, each.planning_time, each.peak_memory / 1e6) for each in [*here, there]
        ]


def test_a_hostile_text_and_an_unknown_environment_are_no_obstacle(tmp_path: Path) -> None:
    result = replace(hostile_result(), environment="nowhere", peak_memory=0)
    with closing(exported(tmp_path / "a.db", [result])) as database:
        assert rows(database, "SELECT name FROM plannerConfigs") == [(result.planner,)]
        assert rows(database, "SELECT version FROM experiments") == [("phframe unknown",)]
        assert rows(database, "SELECT memory, largest_force FROM runs") == [(None, float("inf"))]


def test_no_results_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no results yet"):
        exported(tmp_path / "a.db", [])


@pytest.mark.parametrize(
    ("end", "claimed", "status", "expected"),
    [
        (TrialEnd.FINISHED, "retrieved", "retrieved", OmplStatus.EXACT_SOLUTION),
        (TrialEnd.FINISHED, "retrieved", "failed", OmplStatus.ABORT),
        (TrialEnd.FINISHED, "failed", "failed", OmplStatus.ABORT),
        (TrialEnd.FINISHED, "retrieved", "reached", OmplStatus.APPROXIMATE_SOLUTION),
        (TrialEnd.FINISHED, "cleared", "cleared", OmplStatus.APPROXIMATE_SOLUTION),
        (TrialEnd.FINISHED, "timeout", "timeout", OmplStatus.TIMEOUT),
        (TrialEnd.KILLED, "", "", OmplStatus.TIMEOUT),
        (TrialEnd.CRASHED, "", "", OmplStatus.CRASH),
        (TrialEnd.MEMORY, "", "", OmplStatus.CRASH),
        (TrialEnd.ERROR, "", "", OmplStatus.CRASH),
    ],
)
def test_the_status_is_what_the_referee_saw(end: TrialEnd, claimed: str, status: str, expected: OmplStatus) -> None:
    retrieved = status == "retrieved"
    assert (
        ompl_status(replace(synthetic_result(0), end=end, claimed=claimed, status=status, retrieved=retrieved))
        == expected
    )
