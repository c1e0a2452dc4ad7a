"""How the viewer lays a recording out."""

from __future__ import annotations

import rerun.blueprint as rrb

from phframe.core import BasePose, Shelf
from phframe.recorders import palette
from phframe.recorders.stream import TIME

MARGIN = 0.06
IN_FRONT = 0.22
"""How much of the space before the mouth the top view shows (m)."""


def blueprint_for(shelf: Shelf, base_pose: BasePose) -> rrb.Blueprint:
    """The shelf in 3D and from the top, the decision beside it, the numbers and the story below.

    Args:
        shelf: The shelf.
        base_pose: Where the arm stands: it is looked at from the other side.
    """
    scene = rrb.Horizontal(_solid(shelf, base_pose), _plan_view(shelf), _decision(), column_shares=[5, 5, 3.6])
    story = rrb.Horizontal(*_plots(), _story(), column_shares=[2, 2, 2, 4.6])
    return rrb.Blueprint(
        rrb.Vertical(scene, story, row_shares=[5, 2.1]),
        rrb.TimePanel(state="collapsed", timeline=TIME, play_state="playing"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def _solid(shelf: Shelf, base_pose: BasePose) -> rrb.View:
    aside = 1.55 if base_pose.y < 0.5 * shelf.width else -0.55
    eye = rrb.EyeControls3D(
        position=[-0.55 * shelf.depth - 0.2, aside * shelf.width, 2.0 * shelf.height],
        look_target=[0.42 * shelf.depth, 0.5 * shelf.width, 0.1 * shelf.height],
        eye_up=[0.0, 0.0, 1.0],
    )
    return rrb.Spatial3DView(
        origin="/world", name="Shelf", background=palette.BACKGROUND, line_grid=False, eye_controls=eye
    )


def _plan_view(shelf: Shelf) -> rrb.View:
    bounds = rrb.VisualBounds2D(x_range=[-IN_FRONT, shelf.depth + MARGIN], y_range=[-shelf.width - MARGIN, MARGIN])
    return rrb.Spatial2DView(
        origin="/", contents="/top/**", name="From the top", background=palette.BACKGROUND, visual_bounds=bounds
    )


def _decision() -> rrb.Container:
    bounds = rrb.VisualBounds2D(x_range=[-0.08, 1.12], y_range=[-0.1, 0.72])
    bars = rrb.Spatial2DView(
        origin="/persistence", name="Persistence", background=palette.BACKGROUND, visual_bounds=bounds
    )
    why = rrb.TextDocumentView(origin="/story/decision", name="Decision")
    return rrb.Vertical(bars, why, row_shares=[1, 1])


def _plots() -> list[rrb.Container | rrb.View]:
    return [
        _plot("corridor", "Obstacles in the corridor", legend=False),
        rrb.Tabs(_plot("displacement", "Displacement (mm)"), _plot("force", "Contact force (N)", legend=False)),
        rrb.Tabs(_plot("radius", "Radii (mm)"), _plot("planning", "Planning time (ms)")),
    ]


def _plot(group: str, name: str, *, legend: bool = True) -> rrb.View:
    corner = rrb.PlotLegend(corner="LeftTop", visible=legend)
    return rrb.TimeSeriesView(
        origin=f"/numbers/{group}", name=name, plot_legend=corner, axis_x=rrb.TimeAxis(link="LinkToGlobal")
    )


def _story() -> rrb.View:
    columns = rrb.TextLogColumns(timeline_columns=[TIME], text_log_columns=["Body"])
    return rrb.TextLogView(origin="/story/log", name="What happened and why", columns=columns)
