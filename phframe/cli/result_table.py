"""The result of ``solve`` for people."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.table import Table
from rich.text import Text

STYLES = {
    "retrieved": "bold green",
    "reached": "yellow",
    "cleared": "yellow",
    "failed": "bold red",
    "timeout": "bold red",
}


def result_table(summary: Mapping[str, Any], directory: Path | None) -> Table:
    """What came of it.

    Args:
        summary: As ``--json`` prints it.
        directory: Where the files are.
    """
    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim", no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in _rows(summary, directory):
        table.add_row(name, value)
    return table


def _rows(summary: Mapping[str, Any], directory: Path | None) -> Iterator[tuple[str, Text | str]]:
    status = summary["status"]
    yield "scene", Text(summary["scene"])
    parts = [summary[part] for part in ("variant", "backend", "arm", "topology")]
    yield "with", Text(f"{', '.join(parts)}; seed {summary['seed']}")
    if planned := _planned_with(summary):
        yield "planned with", Text(", ".join(planned))
    yield "status", Text(status, STYLES.get(status, ""))
    if summary["reason"]:
        yield "reason", Text(summary["reason"])
    yield "pushes", f"{summary['actions']}"
    yield "planning", f"{_seconds(summary['planning_time'])}, {summary['simulated_actions']} actions simulated"
    yield "execution", f"{_seconds(summary['execution_time'])} in the simulated world"
    yield "replans", f"{summary['replans']}"
    yield from _fidelity(summary)
    yield "target moved", f"{1000 * summary['target_moved']:.1f} mm before the grasp"
    yield "toppled", _ids(summary["toppled"])
    yield "spilled", _ids(summary["spilled"])
    yield "wall contact", "yes" if summary["wall_contact"] else "no"
    yield "clean", Text("yes", "green") if summary["clean"] else Text("no", "yellow")
    if directory is not None:
        yield "files", Text(str(directory))
    if summary["recording"]:
        yield "look at it", Text(f"{_viewer()} {summary['recording']}")


def _planned_with(summary: Mapping[str, Any]) -> list[str]:
    """The backend and the arm it was planned with, where they are not those that carried the plan out."""
    return [summary[f"plan_{part}"] for part in ("backend", "arm") if summary[f"plan_{part}"] != summary[part]]


def _fidelity(summary: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How well the plan and the joints' motion held, where the plan was carried out in another world."""
    if not _planned_with(summary):
        return
    yield "motion planning", _seconds(summary["motion_planning_time"])
    yield "tracking error", f"{1000 * summary['tracking_error']:.1f} mm at worst"
    if error := summary["prediction_error"]:
        yield "prediction error", f"{1000 * error['median']:.1f} mm median, {1000 * error['worst']:.1f} mm at worst"


def _seconds(seconds: float) -> str:
    return f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"


def _ids(ids: Sequence[str]) -> Text:
    return Text(", ".join(ids) if ids else "none")


def _viewer() -> str:
    """What opens the viewer, also from an environment that is not activated."""
    return "rerun" if shutil.which("rerun") else f"{sys.executable} -m rerun"
