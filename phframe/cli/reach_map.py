"""The map of what an arm can reach, as a picture."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from phframe.core import Scene
from phframe.motion.reachability import Reachability
from phframe.motion.straight_way import YAWS
from phframe.recorders.scene_plot import draw_shelf, outline_in_shelf

SIZE, DOTS = (6.4, 6.4), 120
"""Of the picture: inches, and dots per inch."""
COLOURS = "#1f6f3f", "#4b944f", "#7ab567", "#abcf80", "#d8e6a4"
"""Of cells that are reached straight, and with more and more yaw."""
BEYOND, TARGET, OBJECT = "#e5b5ae", "#d62728", "#3b4a63"


def reach_picture(reach: Reachability, scene: Scene, title: str) -> bytes:
    """Draw where the fingertip can be over a shelf, and at which yaw, with the scene's objects: the bytes of a PNG file.

    Args:
        reach: What is reached.
        scene: The shelf and its objects.
        title: Above the map; the fraction is put after it.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot(xlabel="depth x (m), mouth on the left", ylabel="y (m), south wall below")
    axes.set_title(f"{title}: {reach.fraction:.1%} of the shelf within reach", fontsize=11)
    _draw_cells(axes, reach)
    draw_shelf(scene.shelf, axes)
    _draw_objects(axes, scene)
    figure.legend(handles=_legend(reach), loc="outside lower center", ncols=3, frameon=False, fontsize=9)
    content = io.BytesIO()
    figure.savefig(content, dpi=DOTS, format="png")
    return content.getvalue()


def _levels(reach: Reachability) -> Any:
    """For every cell the number of its colour; that of the last one where it is not reached."""
    sizes = sorted({abs(yaw) for yaw in YAWS})
    levels = np.searchsorted(np.array(sizes) + 1e-9, np.abs(reach.yaws))
    return np.where(np.isfinite(reach.yaws), levels, len(sizes))


def _draw_cells(axes: Any, reach: Reachability) -> None:
    from matplotlib.colors import BoundaryNorm, ListedColormap

    colours = [*COLOURS, BEYOND]
    norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
    axes.pcolormesh(
        _edges(reach.depths),
        _edges(reach.widths),
        _levels(reach),
        cmap=ListedColormap(colours),
        norm=norm,
        edgecolors="white",
        linewidth=0.4,
    )


def _edges(centers: Any) -> Any:
    """Where cells around evenly spaced centres begin and end."""
    step = centers[1] - centers[0] if len(centers) > 1 else 0.05
    return np.concatenate([centers - step / 2.0, centers[-1:] + step / 2.0])


def _draw_objects(axes: Any, scene: Scene) -> None:
    from matplotlib.patches import Polygon

    for item in scene.objects:
        colour = TARGET if item.id == scene.target else OBJECT
        axes.add_patch(
            Polygon(outline_in_shelf(item), facecolor=(1.0, 1.0, 1.0, 0.45), edgecolor=colour, lw=2, zorder=5)
        )
    x, y = scene.objects[scene.target_index].position
    axes.plot(x, y, marker="x", color=TARGET, zorder=6)


def _legend(reach: Reachability) -> list[Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    sizes = np.degrees(sorted({abs(yaw) for yaw in YAWS}))
    texts = ["reached straight" if size == 0.0 else f"at ±{size:.0f}° yaw" for size in sizes]
    cells = [Patch(color=colour, label=text) for colour, text in zip(COLOURS, texts, strict=True)]
    if not np.isfinite(reach.yaws).all():
        cells.append(Patch(color=BEYOND, label="out of reach"))
    return cells + [
        Line2D([], [], marker="o", ls="", ms=9, mfc="none", mec=colour, label=text)
        for colour, text in ((TARGET, "target"), (OBJECT, "other objects"))
    ]
