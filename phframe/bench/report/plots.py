"""Sections with pictures: the paper's bar charts, distributions, profiles, solved over time, pairs, cost."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

from phframe.bench.report.bars import draw_bars
from phframe.bench.report.charts import draw_cost_split, draw_distributions, draw_profiles, draw_solved_over_time
from phframe.bench.report.data import Group, ReportData
from phframe.bench.report.document import Cell, Column, Fold, Part, Picture, ReportSection, Table, Text
from phframe.bench.report.drawing import as_svg
from phframe.bench.report.overview import PLANNER
from phframe.bench.report.styles import PlannerStyle
from phframe.bench.report.summary import GroupSummary, finished
from phframe.bench.statistics_curves import Curve, ObservedTrial, logrank_p, performance_profiles, solved_over_time
from phframe.bench.statistics_paired import LEAST_TIME, PairedComparison, Problem, compare_all, holm
from phframe.bench.trial_result import TrialEnd, TrialResult

Looks = Mapping[str, PlannerStyle]
NOBODY = "No trial retrieved here, so there is nothing to draw."


def bars_section(summaries: Sequence[GroupSummary], looks: Looks) -> ReportSection:
    """The paper's bar charts."""
    parts = []
    for i, each in enumerate(summaries):
        svg = as_svg(draw_bars([each], looks, headed=False), f"bars{i}", f"Bar charts: {each.group.name}")
        caption = f"{sum(summary.trials for summary in each.planners)} trials of {len(each.planners)} planners."
        parts.append(Fold(each.group.name, (Picture(svg, caption),), open=True))
    return ReportSection(
        "bars", "Success, time and actions",
        "The bar charts of the paper, with intervals of 95 % (Wilson; BCa bootstrap by scene). The upright stroke in the first "
        "panel is the rate of reached, the paper's success. The other panels are means of trials that retrieved; planning time "
        "has a logarithmic axis and therefore points.",
        tuple(parts),
    )  # fmt: skip


def distributions_section(data: ReportData, looks: Looks) -> ReportSection:
    """Histograms of every planner."""

    def draw(group: Group, name: str) -> Iterator[Part]:
        solved = retrieved_only(group)
        if not any(solved.values()):
            yield Text(NOBODY)
            return
        picture = as_svg(draw_distributions(solved, looks), name, f"Distributions: {group.name}")
        yield Picture(
            picture, f"Of {sum(map(len, solved.values()))} trials that retrieved; each row is scaled to its peak."
        )

    about = "How times and actions are spread over the trials that retrieved. The stroke is the median."
    return ReportSection("distributions", "Distributions", about, _folds(data, "distributions", draw))


def profile_section(data: ReportData, looks: Looks) -> ReportSection:
    """Performance profiles."""

    def draw(group: Group, name: str) -> Iterator[Part]:
        common, profiles = profiles_of(group)
        if not common:
            yield Text("The planners have no problem in common, so there is no best one to compare with.")
            return
        picture = as_svg(draw_profiles(profiles, looks), name, f"Performance profiles: {group.name}")
        yield Picture(picture, f"Of the {common} problems with a seed that all planners were given.")

    return ReportSection(
        "profile", "Performance profile",
        "On what fraction of the problems a planner is within a factor of the best planner there (Dolan and Moré 2002). At the "
        "left: how often it is the best; at the right: how much it solves at all. The grasp counts as an action here, so that "
        "ratios exist where no push was needed.",
        _folds(data, "profile", draw),
    )  # fmt: skip


def time_section(data: ReportData, looks: Looks) -> ReportSection:
    """Solved over time."""

    def draw(group: Group, name: str) -> Iterator[Part]:
        end, curves = curves_of(group, data.limits)
        picture = as_svg(draw_solved_over_time(curves, end, looks), name, f"Solved over time: {group.name}")
        yield Picture(picture, _timed_out(group, end))
        yield from _logrank(group, data)

    return ReportSection(
        "time", "Solved over planning time",
        "The fraction of trials retrieved within a planning time (one less Kaplan and Meier's estimate), with bands of 95 %. "
        "Trials that were stopped (out of time or simulations, killed) are censored when they stopped planning, at their limit at "
        "the latest; those whose planner gave up, or that died, stay unsolved to the end.",
        _folds(data, "time", draw),
    )  # fmt: skip


def pairs_section(data: ReportData) -> ReportSection:
    """Every two planners."""
    about = (
        "On the problems and seeds that both were given, and no others. Retrieved: exact McNemar test. Planning time and "
        "actions, where both retrieved: Wilcoxon's signed-rank test. All p are two-sided and adjusted for the number of pairs "
        "of the table by Holm's method; those below 0.05 stand out. "
        "The ratio of times is the first planner's over the second's; actions saved are those that the first needs fewer. "
        "Choose planners to see their rows."
    )
    if len(data.planners) < 2:
        return ReportSection("pairs", "Paired comparison", "There is one planner, and nothing to compare it with.", ())
    return ReportSection("pairs", "Paired comparison", about, _folds(data, "pairs", lambda group, _: _pairs(group)))


def cost_section(data: ReportData) -> ReportSection:
    """What planning time is spent on."""

    def draw(group: Group, name: str) -> Iterator[Part]:
        costs = {planner: _cost(of) for planner, of in group.by_planner.items()}
        told = {planner: cost for planner, cost in costs.items() if sum(cost) > 0}
        if told:
            shares = {planner: [part / sum(cost) for part in cost] for planner, cost in told.items()}
            picture = as_svg(draw_cost_split(shares, COSTS), name, f"Cost split: {group.name}")
            yield Picture(picture, "All time before the arm moves, all trials that gave an episode together.")
        columns = (PLANNER, *(Column(f"{each}, mean", "s", "number", 4) for each in COSTS))
        counts = {planner: max(len(finished(of)), 1) for planner, of in group.by_planner.items()}
        rows: list[tuple[Cell, ...]] = [
            (planner, *(part / counts[planner] for part in cost)) for planner, cost in costs.items()
        ]
        yield Table("Mean of a trial", columns, tuple(rows))

    return ReportSection(
        "cost", "Cost split",
        "What the time before the arm moves goes into. The rest is planning that is neither topology nor simulation. With "
        "several workers, simulation is the sum over them and can exceed the wall time; the rest is then 0.",
        _folds(data, "cost", draw),
    )  # fmt: skip


COSTS = ("topology", "simulation", "motion planning", "rest")


def _cost(of: Sequence[TrialResult]) -> list[float]:
    told = finished(of)
    topology, simulation, motion, planning = (
        sum(getattr(r, f"{name}_time") for r in told)
        for name in ("topology", "simulation", "motion_planning", "planning")
    )
    return [topology, simulation, motion, max(planning - topology - simulation, 0.0)]


def _folds(data: ReportData, name: str, draw: Callable[[Group, str], Iterator[Part]]) -> tuple[Part, ...]:
    return tuple(Fold(group.name, tuple(draw(group, f"{name}{i}")), open=i == 0) for i, group in enumerate(data.groups))


def retrieved_only(group: Group) -> dict[str, list[TrialResult]]:
    """The trials of each planner that retrieved."""
    return {name: [result for result in of if result.retrieved] for name, of in group.by_planner.items()}


def profiles_of(group: Group) -> tuple[int, list[tuple[str, dict[str, Curve]]]]:
    """On how many common problems, and the profiles of planning time and of actions."""
    tables = by_problem(group)
    common = sorted(set.intersection(*(set(table) for table in tables.values())))
    costs: Sequence[tuple[str, Callable[[TrialResult], float]]] = (
        ("Planning time", lambda r: max(r.planning_time, LEAST_TIME)),
        ("Actions", lambda r: r.pushes + 1.0),
    )
    if not common:
        return 0, []
    return len(common), [(title, performance_profiles({
        name: [cost(table[each]) if table[each].retrieved else math.inf for each in common]
        for name, table in tables.items()
    })) for title, cost in costs]  # fmt: skip


def by_problem(group: Group) -> dict[str, dict[Problem, TrialResult]]:
    """The results of each planner by suite, problem and seed."""
    return {
        name: {(result.suite, result.problem, result.seed): result for result in of}
        for name, of in group.by_planner.items()
    }


def curves_of(group: Group, limits: Mapping[str, float]) -> tuple[float, dict[str, Curve]]:
    """Until when (s), and the fraction solved over planning time of each planner."""
    end = _end_of_time(group, limits)
    return end, {
        name: solved_over_time([observed(result, limits[result.key], end) for result in of])
        for name, of in group.by_planner.items()
    }


def _end_of_time(group: Group, limits: Mapping[str, float]) -> float:
    """The longest limit where anything ran into one, else a little beyond the last that was solved."""
    results = [result for of in group.by_planner.values() for result in of]
    longest = max(limits[result.key] for result in results)
    if any(timed_out(result) for result in results):
        return longest
    return min(longest, max([1.5 * result.planning_time for result in results if result.retrieved] or [longest]))


def timed_out(result: TrialResult) -> bool:
    """Whether a trial ended because its time, or its simulations, were used up."""
    return not result.retrieved and ("timeout" in (result.status, result.claimed) or result.end is TrialEnd.KILLED)


def observed(result: TrialResult, limit: float, end: float) -> ObservedTrial:
    """A trial as it is told over planning time: solved, stopped, or given up and unsolved to the end.

    One that was stopped was observed for no longer than it planned; a killed one, whose planning time nobody knows, for no
    longer than it lived.
    """
    if result.retrieved:
        return ObservedTrial(max(result.planning_time, LEAST_TIME), solved=True)
    if not timed_out(result):
        return ObservedTrial(max(end, limit), solved=False)
    seen = result.wall_time if result.end is TrialEnd.KILLED else result.planning_time
    return ObservedTrial(max(min(limit, seen), LEAST_TIME), solved=False)


def _timed_out(group: Group, end: float) -> str:
    results = [result for of in group.by_planner.values() for result in of]
    late = sum(map(timed_out, results))
    return f"Up to {end:.3g} s. Of {len(results)} trials, {late} ran out of time or simulations, or were killed."


def _logrank(group: Group, data: ReportData) -> Iterator[Part]:
    """The log-rank test of every two planners, on the lowest seed of each scene, so that trials are independent."""
    end = _end_of_time(group, data.limits)
    tables = {
        name: {key: observed(result, data.limits[result.key], end) for key, result in _first_seeds(table).items()}
        for name, table in by_problem(group).items()
    }
    rows: list[tuple[str, str, int, float]] = []
    for a, b in combinations(tables, 2):
        common = sorted(tables[a].keys() & tables[b].keys())
        p = logrank_p(*([tables[x][each] for each in common] for x in (a, b))) if common else None
        if p is not None:
            rows.append((a, b, len(common), p))
    if rows:
        adjusted = holm([row[3] for row in rows])
        cells = tuple((*row[:3], p) for row, p in zip(rows, adjusted, strict=True))
        columns = (
            PLANNER,
            Column("against", kind="planner"),
            Column("scenes", kind="number"),
            Column("p, log-rank", kind="p"),
        )
        marked = frozenset((i, 3) for i, p in enumerate(adjusted) if p < 0.05)
        title = "Log-rank test of each two (one seed a scene; p adjusted by Holm's method)"
        yield Fold(title, (Table("Each two planners", columns, cells, marked, pick=True),))


def _first_seeds(table: Mapping[Problem, TrialResult]) -> dict[tuple[str, str], TrialResult]:
    return {key[:2]: table[key] for key in sorted(table, reverse=True)}


_PAIRS = (
    PLANNER, Column("against", kind="planner"), Column("pairs", kind="number"), Column("scenes", kind="number"),
    Column("only the first", kind="number"), Column("only the second", kind="number"), Column("both", kind="number"),
    Column("neither", kind="number"), Column("p, retrieved", kind="p"),
    Column("time ratio, median", kind="number", digits=None), Column("p, time", kind="p"),
    Column("actions saved, mean", kind="number", digits=2), Column("p, actions", kind="p"),
    Column("left out, unpaired", kind="number"),
)  # fmt: skip


def _pairs(group: Group) -> Iterator[Part]:
    found = compare_all(by_problem(group))
    if not found:
        yield Text("No two planners have a problem and seed in common here, so nothing is compared.")
        return
    rows = tuple(map(_pair, found))
    tests = (8, 10, 12)
    marked = frozenset((i, j) for i, row in enumerate(rows) for j in tests if _below(row[j]))
    yield Table("Each two planners", _PAIRS, rows, marked, pick=True)


def _below(p: Any) -> bool:
    return isinstance(p, float) and p < 0.05


def _pair(each: PairedComparison) -> tuple[Cell, ...]:
    return (
        each.a, each.b, each.pairs, each.scenes, each.only_a, each.only_b, each.both, each.neither, each.retrieved_p,
        each.time_ratio, each.time_p, each.fewer_pushes, each.pushes_p, each.unpaired,
    )  # fmt: skip
