"""Distributions, performance profiles, solved over time, and what planning time is spent on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from phframe.bench.report.drawing import INK, MUTED, PAPER, SHADES, colour_of, logarithmic, new_figure, shortened
from phframe.bench.report.styles import DASHES, PlannerStyle
from phframe.bench.statistics_curves import Curve
from phframe.bench.trial_result import TrialResult
from phframe.core import FloatArray
from phframe.core.value import IntArray

WIDTH, ROW, MARGIN, CURVES = 10.6, 0.36, 0.95, 3.5
"""Of a figure, of a planner's row, above and below all rows, and of curves (inches)."""
BINS = 48
"""Of a distribution."""
POINTS = 160
"""Most steps of a curve that are drawn."""
_HEIGHT = 0.82
"""Of the highest distribution, in rows."""

_FIGURES: Sequence[tuple[str, Callable[[TrialResult], float], bool, bool]] = (
    ("Planning time [s]", lambda r: r.planning_time, True, False),
    ("Execution time [s]", lambda r: r.execution_time, False, False),
    ("Actions", lambda r: r.pushes, False, True),
)
"""Title, the figure of a trial, whether its axis is logarithmic, whether it is a whole number."""


def draw_distributions(by_planner: Mapping[str, Sequence[TrialResult]], looks: Mapping[str, PlannerStyle]) -> Any:
    """A histogram in each planner's row, with its median; planners have at least one trial altogether."""
    figure, panels = new_figure(WIDTH, MARGIN + ROW * len(by_planner), 3, sharey=True)
    panels[0].set_yticks(np.arange(len(by_planner)) + 0.5 - _HEIGHT / 2, [shortened(name) for name in by_planner])
    panels[0].set_ylim(len(by_planner) - 0.4, -0.55)
    for panel, (title, figure_of, in_logarithms, whole) in zip(panels, _FIGURES, strict=True):
        values = {name: np.array([figure_of(r) for r in of], float) for name, of in by_planner.items()}
        _ridges(panel, values, looks, _edges(values, in_logarithms, whole))
        panel.set_title(title)
        if in_logarithms:
            panel.set_xscale("log")
            logarithmic(panel.xaxis)
        panel.grid(visible=False, axis="y")
    return figure


def _edges(values: Mapping[str, FloatArray], in_logarithms: bool, whole: bool) -> FloatArray:
    everything = np.concatenate(list(values.values()))
    if whole and everything.max() - everything.min() < BINS:
        return np.arange(everything.min(), everything.max() + 2) - 0.5
    if not in_logarithms:
        return np.linspace(everything.min(), max(everything.max(), everything.min() + 1.0), BINS + 1)
    low = max(float(everything.min()), 1e-6)
    return np.geomspace(low, max(float(everything.max()), low * 1.1), BINS + 1)


def _ridges(panel: Any, values: Mapping[str, FloatArray], looks: Mapping[str, PlannerStyle], edges: FloatArray) -> None:
    for row, (name, found) in enumerate(values.items()):
        if not found.size:
            continue
        counts, _ = np.histogram(np.clip(found, edges[0], edges[-1]), edges)
        foot = row + 0.36
        heights = np.append(counts, counts[-1]) / counts.max() * _HEIGHT
        colour, hollow = colour_of(looks[name]), looks[name].variant > 0
        panel.fill_between(
            edges, foot - heights, foot, step="post", lw=1.0, ec=colour, fc=PAPER if hollow else colour,
            alpha=None if hollow else 0.8,
        )  # fmt: skip
        panel.plot([np.median(found)] * 2, [foot, foot - _HEIGHT], color=INK, lw=1.5, solid_capstyle="butt")


def draw_profiles(profiles: Sequence[tuple[str, Mapping[str, Curve]]], looks: Mapping[str, PlannerStyle]) -> Any:
    """A panel for each cost, over the factor to the best planner."""
    figure, panels = new_figure(WIDTH, CURVES, len(profiles), sharey=True)
    for panel, (title, curves) in zip(panels, profiles, strict=True):
        end = max([float(curve.x[-1]) for curve in curves.values() if curve.x.size] or [2.0]) * 1.15
        for name, curve in curves.items():
            _step(panel, curve, looks[name], name, 1.0, max(end, 2.0))
        panel.set_xscale("log")
        panel.set_xlim(1.0, max(end, 2.0))
        logarithmic(panel.xaxis, fixed=True)
        panel.set_title(title)
        panel.set_xlabel("factor to the best planner on the same problem")
    _finish(figure, panels, "problems [%]")
    return figure


def draw_solved_over_time(
    curves: Mapping[str, Curve], end: float, looks: Mapping[str, PlannerStyle], *, band: bool = True
) -> Any:
    """One panel, over planning time up to ``end`` (s), each planner with its band."""
    figure, (panel,) = new_figure(WIDTH, CURVES, 1)
    begin = min([float(curve.x[0]) for curve in curves.values() if curve.x.size] or [end / 10]) * 0.8
    begin = max(begin, 1e-4)
    for name, curve in curves.items():
        _step(panel, curve, looks[name], name, begin, end)
        told = np.isfinite(curve.low) & np.isfinite(curve.high)
        if band and told.any():
            few = _thinned(curve.x[told].size)
            x, low, high = (np.asarray(each)[told][few] for each in (curve.x, 100 * curve.low, 100 * curve.high))
            panel.fill_between(x, low, high, step="post", lw=0, color=colour_of(looks[name]), alpha=0.12)
    panel.set_xscale("log")
    panel.set_xlim(begin, max(end, begin * 2))
    logarithmic(panel.xaxis)
    panel.set_xlabel("planning time [s]")
    _finish(figure, [panel], "retrieved [%]")
    return figure


def _thinned(count: int) -> IntArray:
    """Which of many steps are drawn."""
    return np.unique(np.linspace(0, max(count - 1, 0), min(count, POINTS)).round().astype(np.int64))


def _step(panel: Any, curve: Curve, look: PlannerStyle, name: str, begin: float, end: float) -> None:
    few = _thinned(curve.x.size)
    x = np.concatenate([[begin], np.maximum(curve.x[few], begin), [end]])
    y = np.concatenate([[0.0], curve.y[few], curve.y[-1:] if curve.y.size else [0.0]]) * 100
    colour, label = colour_of(look), shortened(name)
    panel.step(x, y, where="post", color=colour, lw=1.8, ls=DASHES[look.variant], label=label)


def _finish(figure: Any, panels: Sequence[Any], label: str) -> None:
    panels[0].set_ylim(0, 102)
    panels[0].set_ylabel(label)
    for panel in panels:
        panel.tick_params(axis="y", labelcolor=MUTED)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper")


def draw_cost_split(parts: Mapping[str, Sequence[float]], names: Sequence[str]) -> Any:
    """A bar for each planner, of the fractions of its planning that go into each part."""
    figure, (panel,) = new_figure(WIDTH, MARGIN + 0.27 * len(parts), 1)
    for row, fractions in enumerate(parts.values()):
        left = 0.0
        for fraction, shade in zip(fractions, SHADES, strict=True):
            panel.barh(row, 100 * fraction, 0.62, left=left, color=shade, lw=0)
            left += 100 * fraction
    panel.set_yticks(range(len(parts)), [shortened(name) for name in parts])
    panel.set_ylim(len(parts) - 0.4, -0.6)
    panel.set_xlim(0, 100)
    panel.grid(visible=False, axis="y")
    panel.set_xlabel("of the time before the arm moves [%]")
    from matplotlib.patches import Patch

    figure.legend([Patch(color=shade) for shade in SHADES], names, loc="outside right upper")
    return figure
