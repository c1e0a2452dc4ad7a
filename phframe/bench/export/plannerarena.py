"""Results as a database of Planner Arena, the benchmark viewer of OMPL (``pip install plannerarena``).

Source of the tables: OMPL's ``ompl_benchmark_statistics.py``. Planner Arena takes the columns of ``experiments`` after the
twelfth as parameters of the problem, those of ``runs`` after the third as what was measured, and draws the one enum,
``status``, as bars.
"""

from __future__ import annotations

import sqlite3
from collections import Counter
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import Any

from phframe.bench.environment import Environment
from phframe.bench.export.columns import COLUMNS, ColumnKind, plain_value
from phframe.bench.export.content import ExportContent
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import InputError, Status


class OmplStatus(IntEnum):
    """The planner states of OMPL (``ompl/base/PlannerStatus.h``)."""

    UNKNOWN = 0
    INVALID_START = 1
    INVALID_GOAL = 2
    UNRECOGNIZED_GOAL_TYPE = 3
    TIMEOUT = 4
    APPROXIMATE_SOLUTION = 5
    EXACT_SOLUTION = 6
    CRASH = 7
    ABORT = 8
    INFEASIBLE = 9


PARAMETERS = ("suite", "backend", "arm", "plan_backend", "plan_arm")
"""Of an experiment, which is one problem solved by one choice of these in one environment."""
_MEASURED = tuple(
    column
    for column in COLUMNS
    if column.kind in (ColumnKind.BOOLEAN, ColumnKind.INTEGER, ColumnKind.NUMBER)
    and column.name not in ("planning_time", "peak_memory")  # as OMPL names them: time, and memory in MB
)
_TYPES: Mapping[ColumnKind, str] = {
    ColumnKind.BOOLEAN: "BOOLEAN",
    ColumnKind.INTEGER: "INTEGER",
    ColumnKind.NUMBER: "REAL",
}
_BYTES_PER_MB = 1_000_000
_SCHEMA = f"""
CREATE TABLE experiments (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512), totaltime REAL, timelimit REAL,
  memorylimit REAL, runcount INTEGER, version VARCHAR(128) NOT NULL, hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME,
  seed INTEGER, setup TEXT, {", ".join(f"{name} TEXT" for name in PARAMETERS)});
CREATE TABLE plannerConfigs (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL, settings TEXT);
CREATE TABLE enums (name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
CREATE TABLE runs (id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, plannerid INTEGER, status ENUM, time REAL,
  memory REAL, {", ".join(f"{column.name} {_TYPES[column.kind]}" for column in _MEASURED)},
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
CREATE TABLE progress (runid INTEGER, time REAL, PRIMARY KEY (runid, time),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
"""


@dataclass(slots=True)
class _Experiment:
    """What is known of an experiment when its runs have been seen."""

    number: int
    first: TrialResult
    total_time: float = 0.0
    runs: Counter[int] = field(default_factory=Counter)


def write_plannerarena(content: ExportContent, path: Path) -> None:
    """Write the database into an empty file; memory grows with problems and planners, not with trials.

    Raises:
        InputError: If there are no results: Planner Arena opens no database without any.
        OSError: If it cannot be written.
    """
    try:
        with closing(sqlite3.connect(path)) as database:
            database.execute("PRAGMA journal_mode = OFF")  # nobody else has this file, and it is put in place whole
            database.execute("PRAGMA synchronous = OFF")
            database.executescript(_SCHEMA)
            with database:
                _fill(database, content)
    except sqlite3.Error as error:
        raise OSError(str(error)) from error


def ompl_status(result: TrialResult) -> OmplStatus:
    """What OMPL would call this outcome, as the referee saw it: whatever the planner claimed."""
    if result.retrieved:
        return OmplStatus.EXACT_SOLUTION
    if result.end is TrialEnd.KILLED or result.status == Status.TIMEOUT:
        return OmplStatus.TIMEOUT
    if result.end is not TrialEnd.FINISHED:
        return OmplStatus.CRASH
    return OmplStatus.APPROXIMATE_SOLUTION if result.status in (Status.REACHED, Status.CLEARED) else OmplStatus.ABORT


def _fill(database: sqlite3.Connection, content: ExportContent) -> None:
    database.executemany("INSERT INTO enums VALUES ('status', ?, ?)", [(each.value, each.name) for each in OmplStatus])
    experiments: dict[tuple[str, ...], _Experiment] = {}
    planners: dict[str, int] = {}
    marks = ", ".join("?" * (6 + len(_MEASURED)))
    for result in content.results:
        of = (result.problem, result.environment, *(getattr(result, name) for name in PARAMETERS))
        experiment = experiments.setdefault(of, _Experiment(len(experiments) + 1, result))
        planner = planners.setdefault(result.planner, len(planners) + 1)
        experiment.total_time += result.wall_time
        experiment.runs[planner] += 1
        database.execute(f"INSERT INTO runs VALUES ({marks})", _run(result, experiment.number, planner))
    if not experiments:
        raise InputError(
            "there are no results yet, and Planner Arena opens no database without any: run the bench first"
        )
    for experiment in experiments.values():
        row = _experiment_row(experiment, content)
        database.execute(f"INSERT INTO experiments VALUES ({', '.join('?' * len(row))})", row)
    for name, number in planners.items():
        options = name.partition("[")[2].removesuffix("]")
        database.execute("INSERT INTO plannerConfigs VALUES (?, ?, ?)", (number, name, options))


def _run(result: TrialResult, experiment: int, planner: int) -> tuple[Any, ...]:
    memory = result.peak_memory / _BYTES_PER_MB if result.peak_memory else None
    measured = (plain_value(column, result) for column in _MEASURED)
    return (None, experiment, planner, int(ompl_status(result)), float(result.planning_time), memory, *measured)


def _experiment_row(experiment: _Experiment, content: ExportContent) -> tuple[Any, ...]:
    """The fixed twelve columns, then the parameters."""
    first, settings = experiment.first, content.settings
    where = content.environments.get(first.environment, Environment())
    setup = f"{first.spec}\n{where.to_json()}"
    limits = (settings.loop.time_limit, float(settings.memory_limit), max(experiment.runs.values()))
    about = (_version(where), "", where.cpu, first.started, first.seed, setup)
    parameters = (getattr(first, name) for name in PARAMETERS)
    return (experiment.number, first.problem, experiment.total_time, *limits, *about, *parameters)


def _version(where: Environment) -> str:
    version = where.versions.get("phframe", "unknown")
    return f"phframe {version} {where.commit}".rstrip()
