"""The map of what an arm can reach, as a picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from phframe.arms.reach import Reachability
from phframe.core import Scene


def draw_reach(reach: Reachability, scene: Scene, title: str, path: Path) -> None:
    """Draw where the fingertip can be over a shelf, and at which yaw, with the scene's objects.

    Args:
        reach: What is reached.
        scene: The shelf and its objects.
        title: Above the map.
        path: The PNG file to write.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Rectangle

    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot(title=f"{title}: {reach.share:.1%} of the shelf", xlabel="depth (m)", ylabel="y (m)")
    depths, widths = np.meshgrid(reach.depths, reach.widths)
    known = np.isfinite(reach.yaws)
    least = np.degrees(np.abs(reach.yaws[known]))
    marks = axes.scatter(depths[known], widths[known], s=30, c=least, marker="s", cmap="viridis_r", vmin=0.0, vmax=30.0)
    axes.scatter(depths[~known], widths[~known], s=20, c="crimson", marker="x", label="out of reach")
    figure.colorbar(marks, ax=axes, label="least yaw of the gripper (degrees)")
    for item in scene.objects:
        colour = "tab:orange" if item.id == scene.target else "black"
        axes.add_patch(Circle(item.position, item.radius, fill=False, color=colour, linewidth=1.5))
    axes.add_patch(Rectangle((0.0, 0.0), scene.shelf.depth, scene.shelf.width, fill=False))
    if not known.all():
        axes.legend(loc="upper left")
    axes.set_aspect("equal")
    axes.autoscale_view()
    figure.savefig(path, dpi=120)
