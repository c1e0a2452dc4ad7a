"""A bench as tables for people."""

from __future__ import annotations

from collections.abc import Iterable

from rich.table import Table
from rich.text import Text

from phframe.bench.session import Selected
from phframe.bench.summary import SummaryLine


def summary_table(lines: Iterable[SummaryLine]) -> Table:
    """Every planner on every suite."""
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for name in ("planner", "suite"):
        table.add_column(name, overflow="fold")
    for name in ("trials", "retrieved", "95 % interval", "clean", "mean pushes", "median planning", "failures"):
        table.add_column(name, justify="right", no_wrap=True)
    for line in lines:
        table.add_row(Text(line.planner), Text(line.suite), *_figures(line))
    return table


def trial_table(selected: Iterable[Selected]) -> Table:
    """Every trial and what became of it."""
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for name in ("trial", "problem", "planner", "seed", "end", "status", "reason"):
        table.add_column(name, overflow="fold")
    for each in selected:
        trial, result = each.trial, each.result
        came = ("to do", "", "") if result is None else (str(result.end), result.status, result.reason)
        texts = (trial.key[:8], trial.problem, trial.planner, str(trial.spec.seed), *came)
        table.add_row(*(Text(text) for text in texts))
    return table


def _figures(line: SummaryLine) -> tuple[str, ...]:
    return (
        f"{line.trials}",
        f"{line.retrieved} ({line.retrieved / line.trials:.0%})",
        f"{line.low:.0%} to {line.high:.0%}",
        f"{line.clean}",
        "-" if line.pushes is None else f"{line.pushes:.2f}",
        "-" if line.planning_time is None else _seconds(line.planning_time),
        f"{line.failures}",
    )


def _seconds(seconds: float) -> str:
    return f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"
