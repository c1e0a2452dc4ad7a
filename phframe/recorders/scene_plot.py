"""A scene from the top, drawn by matplotlib (extra ``plots``): on axes of the caller's, or as a picture."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np

from phframe.core import FloatArray, Scene, SceneObject, Shelf, rotation_matrix
from phframe.pushing import Corridor
from phframe.recorders.scene_overview import SceneOverview, scene_overview

SIZE, DOTS = (6.4, 6.8), 120
"""Of the picture: inches, and dots per inch."""
WALL, OUTSIDE = 0.02, 0.1
"""Thickness of a drawn wall, and what is shown before the mouth, in the shelf's larger side."""
WOOD, STRIP, STRIP_EDGE = "#5a4632", "#dcebf7", "#5898ce"
TARGET, MEMBER, OBSTACLE, INK = "#f0a020", "#7fb2dd", "#c3cad2", "#1f2933"
_SMALLEST, _LARGEST = 3.0, 9.0
"""Letters of the ids (points)."""
_LETTER = 0.62
"""Width of a letter, in its height."""


def scene_picture(scene: Scene) -> bytes:
    """Draw a scene with its corridor and the ids of its objects: the bytes of a PNG file."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    overview = scene_overview(scene)
    figure = Figure(figsize=SIZE, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot(xlabel="depth x (m), mouth on the left", ylabel="y (m), south wall below")
    axes.set_title(_title(overview), fontsize=10)
    draw_scene(overview, axes)
    figure.legend(handles=_legend(overview), loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    content = io.BytesIO()
    with warnings.catch_warnings(action="ignore", category=UserWarning):  # letters that the font lacks are boxes
        figure.savefig(content, dpi=DOTS, format="png")
    return content.getvalue()


def draw_scene(scene: Scene | SceneOverview, axes: Any, *, ids: bool = True) -> None:
    """Draw a scene from the top: the shelf with its mouth, the corridor, the objects, the target in amber.

    Args:
        scene: The scene, or its overview.
        axes: Of matplotlib; x is the depth, y goes from the south to the north wall (m).
        ids: Whether to write the objects' ids on them.
    """
    overview = scene if isinstance(scene, SceneOverview) else scene_overview(scene)
    corners = _corners(overview.corridor) if isinstance(overview.corridor, Corridor) else np.empty((0, 2))
    draw_shelf(overview.scene.shelf, axes, before=float(-corners[:, 0].min(initial=0.0)))
    if len(corners):
        axes.fill(*corners.T, facecolor=STRIP, edgecolor=STRIP_EDGE, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
    for item in overview.scene.objects:
        _draw_object(overview, item, axes, label=ids)


def draw_shelf(shelf: Shelf, axes: Any, *, before: float = 0.0) -> None:
    """Draw the walls, the mouth and an arrow that goes in, and set the limits of the axes.

    Args:
        shelf: The shelf.
        axes: Of matplotlib, as for ``draw_scene``.
        before: How far before the mouth there is something to be seen (m).
    """
    depth, width = shelf.depth, shelf.width
    wall, outside = WALL * max(depth, width), OUTSIDE * max(depth, width)
    inner = [(0.0, 0.0), (depth, 0.0), (depth, width), (0.0, width)]
    outer = [(0.0, width + wall), (depth + wall, width + wall), (depth + wall, -wall), (0.0, -wall)]
    axes.fill(*np.array([*inner, *outer]).T, color=WOOD, linewidth=0.0, zorder=4)
    axes.plot([0.0, 0.0], [0.0, width], color=WOOD, linewidth=1.0, linestyle=(0, (5, 4)), zorder=2)
    arrow = {"arrowstyle": "-|>", "color": WOOD}
    axes.annotate("", xy=(-0.1 * outside, width / 2.0), xytext=(-0.8 * outside, width / 2.0), arrowprops=arrow)
    out = max(outside, before + wall)
    axes.set(aspect="equal", xlim=(-out, depth + 2.0 * wall), ylim=(-2.0 * wall, width + 2.0 * wall))


def outline_in_shelf(item: SceneObject) -> FloatArray:
    """Corners ``(k, 2)`` of an object's outline, where it stands in the shelf frame (m)."""
    return np.asarray(item.shape.outline @ rotation_matrix(item.yaw).T + item.position)


def _corners(corridor: Corridor) -> FloatArray:
    """Of the strip ``(4, 2)``, in the shelf frame (m)."""
    low, high = corridor.axis - corridor.half_width, corridor.axis + corridor.half_width
    strip = [[corridor.start, low], [corridor.end, low], [corridor.end, high], [corridor.start, high]]
    return corridor.to_shelf(np.array(strip))


def _draw_object(overview: SceneOverview, item: SceneObject, axes: Any, *, label: bool) -> None:
    colour = MEMBER if item.id in overview.members else OBSTACLE
    colour = TARGET if item.id == overview.scene.target else colour
    axes.fill(*outline_in_shelf(item).T, facecolor=colour, edgecolor=INK, linewidth=0.8, zorder=3)
    if label:
        size = _letter_size(item, axes)
        axes.text(
            *item.position, item.id, fontsize=size, color=INK, ha="center", va="center", zorder=5, parse_math=False
        )


def _letter_size(item: SceneObject, axes: Any) -> float:
    """So that the id fits on the object (points), within reason."""
    axes.apply_aspect()
    (left, _), (right, _) = axes.transData.transform([(0.0, 0.0), (2.0 * item.radius, 0.0)])
    points = (right - left) * 72.0 / axes.figure.dpi
    return float(np.clip(points / (_LETTER * len(item.id)), _SMALLEST, _LARGEST))


def _title(overview: SceneOverview) -> str:
    scene, corridor = overview.scene, overview.corridor
    if isinstance(corridor, Corridor):
        way = f"{'straight' if corridor.beside is None else 'angled'} corridor with {len(overview.members)} in it"
    else:
        way = "no corridor"
    return f"{scene.name}: {len(scene.objects)} objects on {scene.coverage:.0%} of the board, {way}".replace("$", r"\$")


def _legend(overview: SceneOverview) -> list[Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    kinds = ((TARGET, "target"), (MEMBER, "in the corridor"), (OBSTACLE, "not in it"))
    rounds = [Line2D([], [], marker="o", ls="", ms=9, mfc=colour, mec=INK, label=text) for colour, text in kinds]
    if not isinstance(overview.corridor, Corridor):
        return rounds
    return [*rounds, Patch(facecolor=STRIP, edgecolor=STRIP_EDGE, label=f"corridor, w = {overview.half_width:g} m")]
