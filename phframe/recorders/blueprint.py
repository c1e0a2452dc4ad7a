"""How the viewer lays a recording out."""

from __future__ import annotations

import numpy as np
import rerun.blueprint as rrb

from phframe.core import BasePose, FloatArray, Shelf
from phframe.recorders import palette
from phframe.recorders.stream import TIME

MARGIN = 0.06
IN_FRONT = 0.22
"""How much of the space before the mouth the top view shows (m)."""


FIELD_OF_VIEW = 55.0
"""Of the viewer's camera, from bottom to top (degrees)."""
BESIDE, BELOW = 0.45, 0.3
"""How far beside its base (m), and below the board, a robot need not be in view."""


def blueprint_for(shelf: Shelf, base_pose: BasePose, robot: FloatArray | None = None) -> rrb.Blueprint:
    """The shelf in 3D and from the top, the decision beside it, the numbers, the search tree and the story below.

    Args:
        shelf: The shelf.
        base_pose: Where the arm stands: it is looked at from the other side.
        robot: Least and greatest corner ``(2, 3)`` of a robot that is to be in view too, in the shelf frame (m).
    """
    scene = rrb.Horizontal(_solid(shelf, base_pose, robot), _plan_view(shelf), _decision(), column_shares=[5, 5, 3.6])
    story = rrb.Horizontal(*_plots(), _search(), _story(), column_shares=[1.7, 1.7, 3.8, 4.8])
    return rrb.Blueprint(
        rrb.Vertical(scene, story, row_shares=[5, 2.4]),
        rrb.TimePanel(state="collapsed", timeline=TIME, play_state="playing"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def _solid(shelf: Shelf, base_pose: BasePose, robot: FloatArray | None) -> rrb.View:
    position, target = eye_for(shelf, base_pose, robot)
    eye = rrb.EyeControls3D(position=position, look_target=target, eye_up=[0.0, 0.0, 1.0])
    return rrb.Spatial3DView(
        origin="/world", name="Shelf", background=palette.BACKDROP, line_grid=False, eye_controls=eye
    )


def eye_for(shelf: Shelf, base_pose: BasePose, robot: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    """Where the eye is and what it looks at, each ``(3,)`` in the shelf frame (m)."""
    north = base_pose.y < 0.5 * shelf.width
    return _before(shelf, north) if robot is None else _beside(shelf, base_pose, north, robot)


def _before(shelf: Shelf, north: bool) -> tuple[FloatArray, FloatArray]:
    """Eye and what it looks at: the shelf alone, from before the mouth."""
    aside = 1.55 if north else -0.55
    eye = np.array([-0.55 * shelf.depth - 0.2, aside * shelf.width, 2.0 * shelf.height])
    return eye, np.array([0.42 * shelf.depth, 0.5 * shelf.width, 0.1 * shelf.height])


def _beside(shelf: Shelf, base_pose: BasePose, north: bool, robot: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Eye and what it looks at: robot and shelf, from the side; a ball around both fills the view."""
    low = np.minimum(np.maximum(robot[0], [-np.inf, base_pose.y - BESIDE, -BELOW]), 0.0)
    high = np.maximum(
        np.minimum(robot[1], [np.inf, base_pose.y + BESIDE, np.inf]), [shelf.depth, shelf.width, shelf.height]
    )
    ball = 0.5 * float(np.linalg.norm(high - low))
    away = np.array([0.0, 0.8 if north else -0.8, 0.6])
    middle = 0.5 * (low + high)
    return middle + away * ball / np.sin(np.radians(FIELD_OF_VIEW / 2.0)), middle


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
    return rrb.Vertical(bars, why, row_shares=[1.2, 1])


def _plots() -> list[rrb.Container | rrb.View]:
    return [
        rrb.Tabs(
            _plot("corridor", "Obstacles in the corridor", legend=False),
            _plot("displacement", "Displacement (mm)"),
            _plot("force", "Contact force (N)", legend=False),
        ),
        rrb.Tabs(_plot("radius", "Radii (mm)"), _plot("planning", "Planning time (ms)")),
    ]


def _plot(group: str, name: str, *, legend: bool = True) -> rrb.View:
    corner = rrb.PlotLegend(corner="LeftTop", visible=legend)
    return rrb.TimeSeriesView(
        origin=f"/numbers/{group}", name=name, plot_legend=corner, axis_x=rrb.TimeAxis(link="LinkToGlobal")
    )


def _search() -> rrb.View:
    return rrb.GraphView(origin="/search", name="Search tree")


def _story() -> rrb.View:
    columns = rrb.TextLogColumns(timeline_columns=[TIME], text_log_columns=["Body"])
    return rrb.TextLogView(origin="/story/log", name="What happened and why", columns=columns)
