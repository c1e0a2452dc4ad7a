"""``python -m phframe.bench.meters``: measure, print tables, keep the figures in a file."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from statistics import median
from typing import Any

from rich.console import Console
from rich.table import Table

from phframe.bench.meters.certainty import measure_certainty
from phframe.bench.meters.ensemble import measure_ensemble
from phframe.bench.meters.outcomes import Outcome, Tally, deviations, run_suite, tally
from phframe.bench.meters.overhead import measure
from phframe.bench.meters.single import diagram_time, help_times, solve_times
from phframe.bench.meters.space import fit_in_space, measure_in_space
from phframe.core import PhframeError
from phframe.core.files import write_file
from phframe.runtime.scenes import scene_names

WHAT = (
    "suites: solve the published scenes; calibrate: fit a planar backend to MuJoCo; "
    "ensemble: the same sweeps in all engines; certainty: how often plans come off that say how sure they are"
)
PUBLISHED = ("vieira", "papallas")


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure everything, or what is asked for; what cannot be used is one line."""
    given = command_line().parse_args(arguments)
    try:
        _measure(given, Console())
    except PhframeError as error:
        command_line().error(str(error))


def _measure(given: argparse.Namespace, console: Console) -> None:
    scenes = [name for name in scene_names() if name.startswith(PUBLISHED)]
    if given.what == "calibrate":
        figures = fit_in_space(console, given.scenes, scenes, given.backend)
    elif given.what == "ensemble":
        figures = measure_ensemble(console, given.scenes, scenes)
    elif given.what == "certainty":
        names = [*scenes, *(f"random/{seed}" for seed in range(1, given.scenes + 1))]
        figures = measure_certainty(console, names, given.seeds, given.backend)
    elif given.what == "suites":
        figures = {"suites": _suites(console, given, scenes)}
    else:
        figures = {
            "suites": _suites(console, given, scenes),
            "overhead": _overhead(console, scenes),
            "single": _single(console),
            **measure_in_space(console, scenes),
        }
    out = given.out or Path("runs") / f"{'bench' if given.what == 'all' else given.what}.json"
    console.print(f"figures: {write_file(out, json.dumps(figures, indent=1))}")


def command_line() -> argparse.ArgumentParser:
    """What can be asked for."""
    parser = argparse.ArgumentParser(prog="python -m phframe.bench.meters", description="Measure phframe.")
    parser.add_argument(
        "what", nargs="?", choices=["all", "suites", "calibrate", "ensemble", "certainty"], default="all", help=WHAT
    )
    parser.add_argument("--planners", nargs="+", default=["phia", "ooa"], help="planners to run on the suites")
    parser.add_argument("--backend", default="pymunk", help="in which plans are carried out, or that is fitted")
    parser.add_argument("--arm", default="planar", help="that carries them out")
    parser.add_argument(
        "--scenes", type=int, default=40, help="random scenes to fit to, and as many to judge by; or to sweep in"
    )
    parser.add_argument(
        "--seeds", type=int, default=5, help="how often the noise is drawn in each scene, for certainty"
    )
    parser.add_argument(
        "--out", type=Path, help="file for the figures; the default is runs/bench.json or runs/calibrate.json"
    )
    return parser


def _suites(console: Console, given: argparse.Namespace, scenes: Sequence[str]) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    with console.status("solving") as status:
        for planner in given.planners:
            outcomes = run_suite(planner, scenes, status.update, backend=given.backend, arm=given.arm)
            tallies = [tally(planner, suite, [o for o in outcomes if o.suite == suite]) for suite in PUBLISHED]
            tallies.append(tally(planner, "all", outcomes))
            _print_outcomes(console, planner, tallies, outcomes)
            rows += [{**asdict(t), "deviations": deviations(outcomes) if t.suite == "all" else {}} for t in tallies]
    return rows


def _print_outcomes(console: Console, planner: str, tallies: Sequence[Tally], outcomes: Sequence[Outcome]) -> None:
    columns = (
        "suite",
        "scenes",
        "cleared",
        "reached",
        "retrieved",
        "clean",
        "pushes",
        "planning ms",
        "motion ms",
        "execution s",
    )
    table = Table(*columns, title=f"{planner} on the published scenes")
    for t in tallies:
        counts = (t.scenes, t.cleared, t.reached, t.retrieved, t.clean)
        times = (f"{t.planning_time * 1e3:.1f}", f"{t.motion_planning_time * 1e3:.0f}", f"{t.execution_time:.1f}")
        table.add_row(t.suite, *map(str, counts), f"{t.actions:.1f}", *times)
    console.print(table)
    for outcome in outcomes:
        if not outcome.episode.clean:
            console.print(f"  {outcome.scene}: {outcome.episode.status}, {outcome.episode.reason or 'not clean'}")
    used = ", ".join(f"{name} {count}" for name, count in deviations(outcomes).most_common())
    console.print(f"  deviations of what the paper leaves open: {used or 'none'}\n")


def _overhead(console: Console, scenes: Sequence[str]) -> list[dict[str, Any]]:
    with console.status("measuring") as status:
        rows = []
        for name in scenes:
            status.update(f"PHIA beside bare pymunk: {name}")
            rows.append(measure(name))
    table = Table("figure", "median", "worst", "bar", title="PHIA planning, 31 scenes")
    _add(table, "over a bare pymunk loop through the same motions", [row.ratio for row in rows], "1.25 / 1.5")
    _add(table, "over just the steps it took itself", [row.strict_ratio for row in rows], "1.25 / 1.5")
    _add(table, "steps it took, of those in the motions", [row.stepped / row.steps for row in rows], "")
    _add(table, "wall time (ms)", [row.planning * 1e3 for row in rows], "30 / 150")
    console.print(table)
    return [{**asdict(row), "ratio": row.ratio, "strict_ratio": row.strict_ratio} for row in rows]


def _add(table: Table, figure: str, values: Sequence[float], bar: str) -> None:
    table.add_row(figure, f"{median(values):.2f}", f"{max(values):.2f}", bar)


def _single(console: Console) -> dict[str, float]:
    ripser, linkage = diagram_time("ripser"), diagram_time("single-linkage")
    ours, bare = help_times()
    watched, plain = solve_times().T
    table = Table("figure", "value", "bar", title="Single figures")
    table.add_row("one diagram of 20 points, Ripser (microseconds)", f"{ripser * 1e6:.0f}", "100")
    table.add_row("one diagram of 20 points, single linkage (microseconds)", f"{linkage * 1e6:.0f}", "")
    table.add_row("phframe --help over a bare typer program", f"{ours / bare:.2f}", "2")
    table.add_row("phframe solve, watched, over the same in one process", f"{median(watched / plain):.2f}", "")
    table.add_row("the first takes longer than the second by (ms)", f"{median(watched - plain) * 1e3:.0f}", "30")
    console.print(table)
    figures = {"ripser_diagram": ripser, "single_linkage_diagram": linkage, "help": ours, "bare_typer_help": bare}
    return {**figures, "watched_solve": float(median(watched)), "plain_solve": float(median(plain))}


if __name__ == "__main__":
    main()
