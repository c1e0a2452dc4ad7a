"""Figures of the engines in space: what simulating costs, how well the plane predicts them, how it is fitted to that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from statistics import median
from typing import Any

from rich.console import Console
from rich.table import Table

from phframe.bench.meters.calibrate import REFERENCE, TUNINGS, Calibration, calibrate
from phframe.bench.meters.motion_planning import ARM, MotionPlanning, measure_motion_planning
from phframe.bench.meters.simulation import BARE, BARS, Simulation, measure_simulation
from phframe.bench.meters.sweeps import Prediction, compare, outcomes, planned_sweeps, score
from phframe.core import NotInstalledError, OptionError, motion_planner_of
from phframe.registry import Kind, create, load
from phframe.runtime.plan_backend import PYMUNK_FITTED
from phframe.runtime.scenes import find_scene

ENGINE = "mujoco"
"""Whose outcomes are predicted."""
LEAST_ALIKE = 27 / 31
"""In what fraction of the sweeps the same objects are to be in the corridor."""


def measure_in_space(console: Console, scenes: Sequence[str]) -> dict[str, Any]:
    """Simulation of every engine that is installed, and prediction; what is not installed is not measured."""
    table = Table(
        "figure", "median", "worst", "bar", title="In space, 31 scenes; with the planar arm where no other is named"
    )
    figures: dict[str, Any] = {"simulation": [], "prediction": []}
    for backend in filter(_installed, BARE):
        rows = _simulations(console, scenes, backend)
        _add_simulation(table, backend, rows)
        figures["simulation"] += [{**asdict(row), "ratio": row.ratio} for row in rows]
    if _installed(ENGINE):
        predictions = _predictions(console, scenes)
        _add_prediction(table, predictions)
        figures["prediction"] = [asdict(prediction) for prediction in predictions]
    if _installed(ENGINE) and _can_move(ARM):
        motions = _motions(console, scenes)
        _add_motion_planning(table, motions)
        figures["motion_planning"] = [{**asdict(motion), "total": motion.total} for motion in motions]
    console.print(table if table.rows else "In space: no engine is installed, so nothing is measured.")
    return figures


def _installed(backend: str) -> bool:
    try:
        load(Kind.BACKEND, backend)
    except NotInstalledError:
        return False
    return True


def _can_move(arm: str) -> bool:
    """Whether what an arm's motion planner needs is installed."""
    try:
        model = create(Kind.ARM, arm)
        scene = find_scene("vieira/basic")
        motion_planner_of(model, scene, model.default_base_pose(scene.shelf))
    except NotInstalledError:
        return False
    return True


def _motions(console: Console, scenes: Sequence[str]) -> list[MotionPlanning]:
    with console.status("planning motion") as status:
        rows = []
        for name in scenes:
            status.update(f"motion planning with {ARM}: {name}")
            rows.append(measure_motion_planning(name, ENGINE))
    return rows


def _add_motion_planning(table: Table, rows: Sequence[MotionPlanning]) -> None:
    times, totals = [time for row in rows for time in row.actions], [row.total for row in rows]
    planned = len(times) - sum(row.unreachable for row in rows)
    table.add_row(f"motion planning for one action, {ARM} (s)", f"{median(times):.2f}", f"{max(times):.2f}", "0.25 / 2")
    table.add_row(
        f"PHIA's plan and all of {ARM}'s trajectories (s)", f"{median(totals):.2f}", f"{max(totals):.2f}", "1"
    )
    table.add_row(f"actions that {ARM} can do", f"{planned} of {len(times)}", "", "")


def _simulations(console: Console, scenes: Sequence[str], backend: str) -> list[Simulation]:
    """The episodes in which anything was driven."""
    with console.status("simulating") as status:
        rows = []
        for name in scenes:
            status.update(f"{backend} beside its bare engine: {name}")
            rows.append(measure_simulation(name, backend))
    return [row for row in rows if row.steps]


def _add_simulation(table: Table, backend: str, rows: Sequence[Simulation]) -> None:
    ratios = [row.ratio for row in rows]
    figure = f"simulating an episode over a bare {backend} loop with the same steps"
    table.add_row(figure, f"{median(ratios):.2f}", f"{max(ratios):.2f}", f"{BARS[backend]:g}")


def _predictions(console: Console, scenes: Sequence[str]) -> list[Prediction]:
    """Of the first sweep of each scene, as it is planned for the engine."""
    with console.status(f"first sweeps in {ENGINE}"):
        sweeps = planned_sweeps(scenes, PYMUNK_FITTED, first=True)
        return compare(sweeps, outcomes(sweeps, "pymunk", PYMUNK_FITTED), outcomes(sweeps, ENGINE))


def _add_prediction(table: Table, predictions: Sequence[Prediction]) -> None:
    found = score(predictions)
    figure = f"error of pymunk's prediction of {ENGINE}, first sweeps (mm)"
    table.add_row(figure, f"{found.median * 1e3:.1f}", f"{found.worst * 1e3:.0f}", "5")
    least = round(LEAST_ALIKE * found.sweeps)
    table.add_row("the same objects in the corridor then", f"{found.same_corridor} of {found.sweeps}", "", f"{least}")


def fit_in_space(console: Console, scenes: int, published: Sequence[str], backend: str = REFERENCE) -> dict[str, Any]:
    """Fit a planar backend to MuJoCo and print what came of it.

    Raises:
        NotInstalledError: If MuJoCo or the backend is not installed.
        OptionError: If nothing is known to fit of that backend.
    """
    for needed in (ENGINE, backend):
        load(Kind.BACKEND, needed)
    if backend not in TUNINGS:
        raise OptionError(f"backend {backend!r} has nothing to fit to {ENGINE}; these have: {', '.join(TUNINGS)}")
    with console.status("fitting") as status:
        found = calibrate(scenes, published, status.update, backend)
    _print_calibration(console, found)
    return found.as_json()


def _print_calibration(console: Console, found: Calibration) -> None:
    values = Table("option", "default", "fitted", "shipped", title=f"{found.backend}, fitted to MuJoCo")
    for name, before in TUNINGS[found.backend].before.items():
        values.add_row(name, _text(before), _text(found.fitted[name]), _text(found.shipped[name]))
    console.print(values)
    columns = ("sweeps", "with", "sweeps", "objects", "median mm", "mean mm", "worst mm", "same corridor")
    table = Table(*columns, title="Error of the prediction")
    for judged in found.judged:
        beside = () if found.backend == REFERENCE else ("beside",)
        for name in ("before", "fitted", "shipped", *beside):
            s = getattr(judged, name)
            lengths = (f"{length * 1e3:.1f}" for length in (s.median, s.mean, s.worst))
            named = f"{REFERENCE}, shipped" if name == "beside" else name
            table.add_row(judged.sweeps, named, f"{s.sweeps}", f"{s.objects}", *lengths, f"{s.same_corridor}")
    console.print(table)


def _text(value: float | None) -> str:
    return "none" if value is None else f"{value:.3g}"
