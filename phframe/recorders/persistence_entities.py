"""The persistence diagram of a decision as bars: every component is born at 0, so a bar's length is its death."""

from __future__ import annotations

import numpy as np
import rerun as rr

from phframe.core import FloatArray
from phframe.pushing import PushDecision
from phframe.recorders import palette
from phframe.recorders.stream import Stream

HEIGHT = 0.62
"""Of the chart, in parts of its width; the radius that fills the width is chosen anew for each decision."""
STEP = 0.05
"""Between two marks of the scale (m)."""


def log_persistence(stream: Stream, decision: PushDecision) -> None:
    """Bars by length, the persistent ones in blue, and the radius chosen as a line across; wiped off without any."""
    finite, infinite = _lengths(decision)
    span = _span(finite, decision.radius)
    _log_scale(stream, span if len(finite) + infinite else 0.0)
    ends = np.concatenate([finite / span, np.full(infinite, 1.08)])
    rows = HEIGHT * (np.arange(len(ends)) + 0.5) / max(len(ends), 1)
    persistent = _persistent(finite, decision.persistent_radii)
    _log_bars(stream, ends, rows, [*persistent, *[False] * infinite])
    _log_ends(stream, finite[persistent], ends[: len(finite)][persistent], rows[: len(finite)][persistent])
    _log_radius(stream, decision.radius, span)
    note = [] if len(ends) else ["no obstacle"]
    stream.put("persistence/note", _captions([[0.5, HEIGHT / 2]] * len(note), note, palette.TEXT))


def _lengths(decision: PushDecision) -> tuple[FloatArray, int]:
    """The finite deaths (m), and how many components never die."""
    if decision.diagram is None:
        return np.zeros(0), 0
    finite = decision.diagram.finite_deaths
    return finite, len(decision.diagram.deaths) - len(finite)


def _span(finite: FloatArray, radius: float | None) -> float:
    """The radius (m) that fills the width: the next mark of the scale beyond everything there is to see."""
    largest = max([STEP, radius or 0.0, *finite])
    return float(np.ceil(1.02 * largest / STEP)) * STEP


def _persistent(finite: FloatArray, radii: tuple[float, ...]) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Mask of the deaths that are persistent radii."""
    return np.array([any(abs(death - radius) < 1e-9 for radius in radii) for death in finite], dtype=bool)


def _log_scale(stream: Stream, span: float) -> None:
    marks = np.arange(0.0, span + STEP / 2, STEP) if span else np.zeros(0)
    places = marks / span if span else marks
    lines = [[[x, -0.02], [x, HEIGHT + 0.02]] for x in places]
    stream.put("persistence/scale", rr.LineStrips2D(lines, radii=-0.6, colors=palette.FAINT, draw_order=-10.0))
    captions = [f"{1000 * mark:.0f}" + (" mm" if mark == marks[-1] else "") for mark in marks]
    at = [[x, HEIGHT + 0.045] for x in places]
    stream.put("persistence/scale/marks", _captions(at, captions, palette.TEXT))


def _log_bars(stream: Stream, ends: FloatArray, rows: FloatArray, persistent: list[bool]) -> None:
    bars = [[[0.0, row], [end, row]] for end, row in zip(ends, rows, strict=True)]
    colors = [palette.PERSISTENT if yes else palette.OBJECT for yes in persistent]
    stream.put("persistence/bars", rr.LineStrips2D(bars, radii=-2.2, colors=colors))


def _log_ends(stream: Stream, deaths: FloatArray, ends: FloatArray, rows: FloatArray) -> None:
    at = np.column_stack([ends, rows])
    captions = [f"{1000 * death:.0f}" for death in deaths]
    stream.put("persistence/persistent", _captions(at, captions, palette.TEXT, radius=4.0))


def _log_radius(stream: Stream, radius: float | None, span: float) -> None:
    at = [] if radius is None else [radius / span]
    lines = [[[x, -0.02], [x, HEIGHT + 0.02]] for x in at]
    stream.put("persistence/radius", rr.LineStrips2D(lines, radii=-1.2, colors=palette.SWEEP, draw_order=30.0))
    captions = [] if radius is None else [f"chosen radius {1000 * radius:.0f} mm"]
    stream.put("persistence/radius/value", _captions([[x, -0.05] for x in at], captions, palette.TEXT))


def _captions(
    at: FloatArray | list[list[float]], captions: list[str], color: palette.Color, radius: float = 0.0
) -> rr.Points2D:
    return rr.Points2D(at, radii=-radius, labels=captions, colors=color, show_labels=True, draw_order=31.0)
