"""The paper's bar charts: rate of success, planning time, execution time, number of actions, of each planner."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from phframe.bench.report.drawing import GRID, INK, MUTED, PAPER, colour_of, logarithmic, new_figure, shortened
from phframe.bench.report.styles import MARKERS, PlannerStyle
from phframe.bench.report.summary import GroupSummary, PlannerSummary
from phframe.bench.statistics import Estimate

WIDTH, ROW, MARGIN = 10.6, 0.27, 0.85
"""Of the figure, of a planner's row, and above and below all rows (inches)."""
_TITLES = ("Retrieved [%]", "Planning time [s]", "Execution time [s]", "Actions")


def draw_bars(groups: Sequence[GroupSummary], looks: Mapping[str, PlannerStyle], *, headed: bool) -> Any:
    """Four panels, a row for each planner of each group.

    Args:
        groups: From top to bottom.
        looks: Of the planners.
        headed: Whether each group has a row with its suite's name above it.
    """
    rows = _rows(groups, headed)
    figure, panels = new_figure(WIDTH, MARGIN + ROW * len(rows), 4, sharey=True)
    panels[0].set_yticks(range(len(rows)), [shortened(label) for label, _ in rows])
    panels[0].set_ylim(len(rows) - 0.4, -0.6)
    for tick, (_, summary) in zip(panels[0].get_yticklabels(), rows, strict=True):
        tick.set_fontweight("bold" if summary is None else "normal")
    for panel, title in zip(panels, _TITLES, strict=True):
        panel.set_title(title)
        panel.grid(visible=False, axis="y")
    for y, (_, summary) in enumerate(rows):
        if summary is not None:
            _draw_row(panels, y, summary, looks[summary.planner])
    _scale(panels)
    return figure


def _rows(groups: Sequence[GroupSummary], headed: bool) -> list[tuple[str, PlannerSummary | None]]:
    rows: list[tuple[str, PlannerSummary | None]] = []
    for each in groups:
        rows += [(each.group.suite, None)] if headed else []
        rows += [(summary.planner, summary) for summary in each.planners]
    return rows


def _draw_row(panels: Sequence[Any], y: int, summary: PlannerSummary, look: PlannerStyle) -> None:
    rate = summary.retrieved
    _bar(panels[0], y, rate, look, 100.0, "{:.0f}")
    panels[0].plot([100 * summary.reached_rate] * 2, [y - 0.36, y + 0.36], color=INK, lw=1.6, solid_capstyle="butt")
    _point(panels[1], y, summary.planning, look)
    _bar(panels[2], y, summary.execution, look, 1.0, "{:.1f}")
    _bar(panels[3], y, summary.actions, look, 1.0, "{:.2f}")


def _bar(panel: Any, y: int, estimate: Estimate, look: PlannerStyle, scale: float, form: str) -> None:
    if estimate.value is not None:
        colour = colour_of(look)
        panel.barh(y, estimate.value * scale, 0.62, color=PAPER if look.variant else colour, edgecolor=colour, lw=1.2)
        _whisker(panel, y, estimate, scale)
    _write(panel, y, "-" if estimate.value is None else form.format(estimate.value * scale))


def _point(panel: Any, y: int, estimate: Estimate, look: PlannerStyle) -> None:
    """Times are of several orders, and a bar has no beginning on such an axis."""
    if estimate.value:
        _whisker(panel, y, estimate, 1.0)
        panel.plot(
            estimate.value, y, MARKERS[look.variant], ms=6, mew=1.4, mec=colour_of(look),
            mfc=PAPER if look.variant else colour_of(look), zorder=3,
        )  # fmt: skip
    _write(panel, y, "-" if estimate.value is None else f"{estimate.value:.3g}")


def _whisker(panel: Any, y: int, estimate: Estimate, scale: float) -> None:
    if estimate.low is not None and estimate.high is not None:
        ends = [estimate.low * scale, estimate.high * scale]
        panel.plot(ends, [y, y], color=PAPER, lw=3.4, solid_capstyle="butt", zorder=2.4)
        panel.plot(ends, [y, y], color=INK, lw=1.3, solid_capstyle="butt", zorder=2.5)


def _write(panel: Any, y: int, text: str) -> None:
    """The figure in a column at the right of the panel."""
    panel.annotate(
        text, (1.0, y), (34, 0), ("axes fraction", "data"), textcoords="offset points", ha="right", va="center",
        color=MUTED, annotation_clip=False,
    )  # fmt: skip


def _scale(panels: Sequence[Any]) -> None:
    panels[0].set_xlim(0, 100)
    if panels[1].lines:
        panels[1].set_xscale("log")
        logarithmic(panels[1].xaxis)
    panels[1].grid(visible=True, axis="y", color=GRID, lw=0.4)
    for panel in panels[2:]:
        panel.set_xlim(left=0)
