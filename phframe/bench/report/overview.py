"""Sections: what was run, the summary, and the known limitations."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence

from phframe.bench.environment import Environment
from phframe.bench.report.commands import bench_command
from phframe.bench.report.data import BenchSource, ReportData
from phframe.bench.report.document import Cell, Column, Fold, Part, ReportSection, Table, Text
from phframe.bench.report.summary import GroupSummary, PlannerSummary
from phframe.bench.trial_result import TrialResult

PLANNER = Column("planner", kind="planner")


def run_section(data: ReportData) -> ReportSection:
    """What was run: planners with their options, suites, seeds, versions, machine, and the command that repeats it."""
    parts: list[Part] = [_planners(data), _settings(data)]
    for source in data.sources:
        parts += [_source(source), *_environments(source)]
    return ReportSection(
        "run", "What was run",
        "Planners are called by their names with the options that are not the default. Times are of these machines, and "
        "comparable within one machine only.",
        tuple(parts),
    )  # fmt: skip


def _planners(data: ReportData) -> Table:
    by_planner: dict[str, list[TrialResult]] = defaultdict(list)
    for result in data.results:
        by_planner[result.planner].append(result)
    rows: list[tuple[Cell, ...]] = []
    for name, results in sorted(by_planner.items()):
        limits = sorted({data.limits[result.key] for result in results})
        options = json.loads(results[0].spec).get("options", {}).get("planner", {})
        told = ", ".join(f"{key}={value}" for key, value in sorted(options.items())) or "all at their defaults"
        rows.append((name, told, ", ".join(f"{limit:g}" for limit in limits), len(results)))
    columns = (PLANNER, Column("options"), Column("limit of planning", "s", "number"), Column("trials", kind="number"))
    return Table("Planners", columns, tuple(rows))


def _settings(data: ReportData) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for setting, groups in data.settings:
        for group in groups:
            results = [result for of in group.by_planner.values() for result in of]
            rows.append((
                group.suite, setting, len({result.problem for result in results}), len({r.seed for r in results}),
                len(group.by_planner), len(results),
            ))  # fmt: skip
    numbers = (Column(name, kind="number") for name in ("scenes", "seeds", "planners", "trials"))
    return Table("Suites", (Column("suite"), Column("carried out in"), *numbers), tuple(rows))


def _source(source: BenchSource) -> Table:
    started = sorted(result.started for result in source.results if result.started)
    rows: list[tuple[Cell, ...]] = [("trials with a result", f"{len(source.results)}")]
    rows += [("first and last trial begun (UTC)", f"{started[0]} and {started[-1]}")] if started else []
    if source.settings is not None:
        rows.append(("command that repeats it", bench_command(source.settings, source.directory)))
    return Table(f"Bench {source.directory}", (Column("what"), Column("value", kind="command")), tuple(rows))


def _environments(source: BenchSource) -> Iterator[Part]:
    counts = Counter(result.environment for result in source.results)
    for name, environment in sorted(source.environments.items()):
        if counts[name]:
            yield Fold(f"Machine and versions of {counts[name]} trials", (_environment(environment),))


def _environment(environment: Environment) -> Table:
    rows: list[tuple[Cell, ...]] = [
        ("processor", environment.cpu or "not known"),
        ("cores", f"{environment.cores}"),
        ("memory [MB]", f"{environment.memory}" if environment.memory else "not known"),
        ("system", environment.system or "not known"),
        ("commit of phframe", environment.commit or "none: not run from a source tree"),
        *((f"code of {name}", digest) for name, digest in sorted(environment.code.items())),
        *(sorted(environment.versions.items())),
    ]
    return Table("Where the trials ran", (Column("what"), Column("value")), tuple(rows))


_SUMMARY = (
    PLANNER, Column("trials", kind="number"), Column("scenes", kind="number"),
    Column("retrieved", "%", "number", 1, 100.0), Column("reached", "%", "number", 1, 100.0),
    Column("clean", "%", "number", 1, 100.0), Column("planning, mean", "s", "number", 3),
    Column("planning of all, median", "s", "number", 3), Column("execution, mean", "s", "number", 1),
    Column("actions, mean", kind="number", digits=2), Column("simulations of all, mean", kind="number", digits=1),
    Column("without episode", kind="number"),
)  # fmt: skip


def summary_section(summaries: Sequence[GroupSummary]) -> ReportSection:
    """The table of planners by suites."""
    tables = tuple(Table(each.group.name, _SUMMARY, tuple(map(_row, each.planners))) for each in summaries)
    return ReportSection(
        "summary", "Summary",
        "Retrieved is what the referee saw: the target out of the shelf and in the hand. Reached is the paper's success: the "
        "gripper at a grasp pose, its link free. Clean: retrieved, nothing else toppled or spilled, no wall touched. Planning, "
        "execution and actions are of trials that retrieved, so of other scenes for each planner; the paired comparison is not. "
        "Simulations, and where it is said planning, are of all trials that gave an episode. "
        "Intervals of 95 %: Wilson's for rates, bootstrap by scene for means and medians.",
        tables,
    )  # fmt: skip


def _row(summary: PlannerSummary) -> tuple[Cell, ...]:
    return (
        summary.planner, summary.trials, summary.retrieved.scenes, summary.retrieved, summary.reached_rate,
        summary.clean / summary.trials, summary.planning, summary.planning_median, summary.execution, summary.actions,
        summary.simulations, summary.lost,
    )  # fmt: skip


def limitations_section(data: ReportData) -> ReportSection:
    """What the figures do not say, and how often the published method was departed from."""
    return ReportSection(
        "limitations", "Known limitations",
        "What to know before these figures are quoted.",
        (*map(Text, _limitations(data)), *_deviations(data)),
    )  # fmt: skip


def _limitations(data: ReportData) -> Iterator[str]:
    yield (
        "The figures of Vieira et al. (2022) are published as bar charts, not as numbers, and are not repeated here; its "
        "scenes beyond the published positions are generated anew, so rates can be compared in order, not in value."
    )
    yield "Times are wall times of the machines named above, taken while other trials may have run beside them."
    yield "Success is judged by the referee in the simulated world that carried the plan out, not by the planner, nor on a robot."
    yield (
        "What the paper leaves open is settled in ways counted below as deviations; a planner without any there ran as published."
    )
    results = data.results
    if any(len({r.seed for r in of}) > 1 for group in data.groups for of in group.by_planner.values()):
        yield (
            "There are several seeds to a scene, which are not independent: intervals and paired tests count scenes, but the "
            "bands of solved-over-time take every trial for itself and are too narrow where seeds agree."
        )
    limits = sorted({data.limits[result.key] for result in results})
    if len(limits) > 1:
        yield f"Planning was limited to {' or '.join(f'{limit:g} s' for limit in limits)}, not the same for all planners."
    if data.repeated:
        yield f"{data.repeated} trials are in more than one of the benches; each counts once, as in the first named."
    if len({result.environment for result in results}) > 1:
        yield "The trials did not all run on one machine with one set of versions: times are mixed."
    unequal = [group.name for group in data.groups if len({len(of) for of in group.by_planner.values()}) > 1]
    if unequal:
        yield f"Not every planner was given all trials of: {'; '.join(unequal)}. Rates there are not of the same problems."


def _deviations(data: ReportData) -> Iterator[Table]:
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    trials: Counter[str] = Counter()
    pushes: Counter[str] = Counter()
    for result in data.results:
        counts[result.planner].update(result.deviations)
        trials[result.planner] += 1
        pushes[result.planner] += result.pushes
    names = sorted({name for count in counts.values() for name in count})
    if names:
        rows: list[tuple[Cell, ...]] = [
            (p, trials[p], pushes[p], *(counts[p][name] for name in names)) for p in sorted(trials)
        ]
        columns = (PLANNER, *(Column(name, kind="number") for name in ("trials", "pushes", *names)))
        yield Table("Deviations from the published method in what was carried out, counts", columns, tuple(rows))
