"""Sections: claimed against verified, what became of the bystanders, failures, prediction errors."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from phframe.bench.report.commands import replay_command, solve_command
from phframe.bench.report.data import Group, ReportData
from phframe.bench.report.document import Cell, Column, Fold, ReportSection, Table, Text
from phframe.bench.report.overview import PLANNER
from phframe.bench.report.summary import GOAL_MET, finished, strata
from phframe.bench.statistics import typical
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import Status

LISTED = 2000
"""Most failures that are listed one by one."""
REASONS = 60
"""Most reasons that have a table of their own."""
_ORDER = (Status.ACHIEVED, Status.RETRIEVED, Status.REACHED, Status.CLEARED, Status.FAILED, Status.TIMEOUT)
_WORTH = {status.value: len(_ORDER) - i for i, status in enumerate(_ORDER)} | {"achieved": len(_ORDER) - 1}
NOTHING = "no episode"
NO_PLAN = "no plan"


def _count(name: str) -> Column:
    return Column(name, kind="number")


def claims_section(data: ReportData) -> ReportSection:
    """A cross table of what the last plan of each trial promised and what the referee saw."""
    by_setting = {setting: _by_planner(groups) for setting, groups in data.settings}
    return ReportSection(
        "claims", "Claimed against verified",
        "What the last plan of each trial promised, and what the referee saw. Marked: claims that did not come true.",
        (_came_true(by_setting), *(_claims(setting, of) for setting, of in by_setting.items())),
    )  # fmt: skip


def _claims(setting: str, by_planner: Mapping[str, Sequence[TrialResult]]) -> Fold:
    every = [result for of in by_planner.values() for result in of]
    counts = Counter((r.planner, r.claimed or NO_PLAN, r.status or NOTHING) for r in every)
    seen = [*(s.value for s in _ORDER if any(key[2] == s for key in counts)), NOTHING]
    rows: list[tuple[Cell, ...]] = []
    marked: set[tuple[int, int]] = set()
    for planner, claim in product(by_planner, [*(s.value for s in _ORDER), NO_PLAN]):
        found = [counts[planner, claim, status] for status in seen]
        if sum(found):
            worse = [j for j, status in enumerate(seen) if found[j] and _is_worse(status, claim)]
            marked |= {(len(rows), 3 + j) for j in worse}
            rows.append((planner, claim, sum(found), *found))
    columns = (PLANNER, Column("claimed"), _count("trials"), *(_count(f"seen: {status}") for status in seen))
    return Fold(setting, (Table("Trials by claim and outcome", columns, tuple(rows), frozenset(marked)),))


def _is_worse(status: str, claim: str) -> bool:
    promised = _WORTH.get(claim, 0)
    return promised > _WORTH[Status.FAILED] and _WORTH.get(status, 0) < promised


def _came_true(by_setting: Mapping[str, Mapping[str, Sequence[TrialResult]]]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for setting, by_planner in by_setting.items():
        for planner, of in by_planner.items():
            claimed = [r for r in of if r.claimed in GOAL_MET]
            true = sum(result.retrieved for result in claimed)
            share = true / len(claimed) if claimed else None
            rows.append((setting, planner, len(claimed), true, len(claimed) - true, share))
    columns = (
        Column("carried out in"), PLANNER, _count("claimed to retrieve"), _count("came true"), _count("did not"),
        Column("came true", "%", "number", 1, 100.0),
    )  # fmt: skip
    return Table("Claims to retrieve", columns, tuple(rows), frozenset((i, 4) for i, row in enumerate(rows) if row[4]))


def bystanders_section(data: ReportData) -> ReportSection:
    """How far other objects were displaced, and what toppled or spilled."""
    columns = (
        PLANNER, _count("episodes"), Column("displaced, sum of a trial, mean", "mm", "number", 1, 1e3),
        Column("displaced, worst object of all", "mm", "number", 0, 1e3), _count("toppled, objects"),
        _count("trials with one"), _count("spilled, objects"), _count("spilled, trials"), _count("touched a wall, trials"),
        Column("target pushed, mean", "mm", "number", 1, 1e3), Column("largest force", "N", "number", 1),
    )  # fmt: skip
    tables = tuple(
        Fold(group.name, (Table("Bystanders", columns, rows),), open=i == 0)
        for i, group in enumerate(data.groups)
        for rows in [tuple(_bystanders(name, finished(of)) for name, of in group.by_planner.items())]
    )
    return ReportSection(
        "bystanders", "Bystanders",
        "The objects other than the target, in all trials that gave an episode: how far they ended from where they stood, "
        "how many lie on their side, how many left the board.",
        tables,
    )  # fmt: skip


def _bystanders(planner: str, of: Sequence[TrialResult]) -> tuple[Cell, ...]:
    return (
        planner, len(of), typical(strata(of, lambda r: r.displacement)),
        max((r.largest_displacement for r in of), default=None), sum(r.toppled for r in of),
        sum(r.toppled > 0 for r in of), sum(r.spilled for r in of), sum(r.spilled > 0 for r in of),
        sum(r.wall_contact for r in of), typical(strata(of, lambda r: r.target_moved)),
        max((r.largest_force for r in of), default=None),
    )  # fmt: skip


def prediction_section(data: ReportData) -> ReportSection:
    """How well what was planned in predicts what it was carried out in."""
    columns = (
        Column("carried out in"), PLANNER, _count("trials with predictions"),
        Column("error, median of trials", "mm", "number", 1, 1e3), Column("95th percentile", "mm", "number", 1, 1e3),
        Column("worst object", "mm", "number", 0, 1e3), Column("tracking error, worst", "mm", "number", 1, 1e3),
        Column("replans, mean", kind="number", digits=2),
    )  # fmt: skip
    rows = tuple(
        _prediction(setting, planner, finished(of))
        for setting, groups in data.settings
        for planner, of in _by_planner(groups).items()
    )
    return ReportSection(
        "prediction", "Prediction error across fidelities",
        "Distance between where a plan had each moved object and where it was seen, the median of each trial; by what carried "
        "the plans out. Where that is what was planned in, it is the error of repeating a plan, which is none but for noise.",
        (Table("By what carried the plans out", columns, rows),),
    )  # fmt: skip


def _prediction(setting: str, planner: str, of: Sequence[TrialResult]) -> tuple[Cell, ...]:
    told = [result for result in of if result.prediction_error is not None]
    errors = [result.prediction_error for result in told]
    return (
        setting, planner, len(told), typical(strata(told, lambda r: r.prediction_error), "median"),
        float(np.percentile(np.array(errors, float), 95)) if errors else None,
        max((r.largest_prediction_error or 0.0 for r in told), default=None),
        max((r.tracking_error for r in of), default=None),
        float(np.mean([r.replans for r in of])) if of else None,
    )  # fmt: skip


def _by_planner(groups: Sequence[Group]) -> dict[str, list[TrialResult]]:
    found: dict[str, list[TrialResult]] = defaultdict(list)
    for group in groups:
        for planner, of in group.by_planner.items():
            found[planner] += of
    return dict(sorted(found.items()))


def failures_section(data: ReportData, listed: int = LISTED) -> ReportSection:
    """Every failure with its reason, by reason, and the commands that repeat it.

    Args:
        data: What is reported.
        listed: Most failures that are listed one by one; of all, the counts are told.
    """
    failed = [result for result in data.results if not result.retrieved]
    if not failed:
        return ReportSection("failures", "Failures", "Every trial retrieved its target.", ())
    by_reason: dict[str, list[TrialResult]] = defaultdict(list)
    for result in failed:
        by_reason[f"{_end(result)}: {pattern(result.reason)}"].append(result)
    groups = sorted(by_reason.items(), key=lambda item: (-len(item[1]), item[0]))
    each = _allowed([len(of) for _, of in groups[:REASONS]], listed)
    folds = tuple(_fold(title, of, each, data.homes) for title, of in groups[:REASONS])
    return ReportSection(
        "failures", "Failures",
        f"{len(failed)} of {len(data.results)} trials did not retrieve. Reasons that differ in numbers only are one; each "
        "opens to its trials, with the command that repeats the trial from the bench, and the one that solves it anew.",
        (_reasons(groups, data.planners), *folds, *_left_out(len(failed), groups, each)),
    )  # fmt: skip


def _end(result: TrialResult) -> str:
    return (result.status or "failed") if result.end is TrialEnd.FINISHED else result.end.value


def pattern(reason: str) -> str:
    """A reason without its numbers, so that those that differ in them only are one: ``o3 and o12`` becomes ``o#``."""
    text = re.sub(r"\d+(\.\d+)?", "#", reason.strip()) or "no reason given"
    return re.sub(r"(\b[\w-]*#)((, and |, | and )[\w-]*#)+", r"\1", text)[:200]


def _allowed(sizes: Sequence[int], listed: int) -> int:
    """How many of each reason are listed, so that all together are not too many: as many as fit, the same for each."""
    most = max(sizes)
    while most > 1 and sum(min(size, most) for size in sizes) > listed:
        most = most * 9 // 10
    return most


def _reasons(groups: Sequence[tuple[str, list[TrialResult]]], planners: Sequence[str]) -> Table:
    counts = [(title, Counter(r.planner for r in of)) for title, of in groups[:REASONS]]
    rows: list[tuple[Cell, ...]] = [
        (title, sum(count.values()), *(count[name] for name in planners)) for title, count in counts
    ]
    columns = (Column("outcome and reason"), _count("all"), *(_count(name) for name in planners))
    return Table("Trials that did not retrieve, by reason and planner", columns, tuple(rows))


_FAILURE = (
    PLANNER, Column("problem"), Column("seed", kind="number"), Column("carried out in"), Column("reason"),
    Column("repeat it", kind="command"), Column("solve it anew", kind="command"),
)  # fmt: skip


def _fold(title: str, of: Sequence[TrialResult], most: int, homes: Mapping[str, str]) -> Fold:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            r.planner, r.problem, r.seed, f"{r.backend} with {r.arm}", r.reason[:400],
            replay_command(homes[r.key], r.key, r.spec), solve_command(r.spec),
        )
        for r in of[:most]
    )  # fmt: skip
    shown = f"{len(of)} trials" if len(rows) == len(of) else f"{len(rows)} of {len(of)} trials"
    return Fold(f"{title} ({shown})", (Table("Trials", _FAILURE, rows),))


def _left_out(failed: int, groups: Sequence[tuple[str, list[TrialResult]]], each: int) -> Iterator[Text]:
    listed = sum(min(len(of), each) for _, of in groups[:REASONS])
    if listed < failed:
        yield Text(
            f"{failed - listed} further failures are counted above or have one of {max(len(groups) - REASONS, 0)} further "
            "reasons, and are not listed: 'phframe bench export' gives every trial."
        )
