"""Draws an episode from the top, one panel per action: ``draw(phframe.solve("vieira/basic"), "decisions.png")``."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import phframe
from phframe.core import Episode, FloatArray, Scene, Shape, Step, rotate
from phframe.pushing import PushDecision

COMPONENTS = ("#2f80c2", "#8a5fd3", "#2e9e5b", "#d4559b", "#2aa39b", "#8d9b1f")
TARGET, OBSTACLE = "#f0a020", "#a9b2bd"


def draw(episode: Episode, file: str | Path) -> None:
    """Draw every step: corridor, components in colour, rectangle, the gripper's path, and where things end (dashed)."""
    figure = Figure(figsize=(3.4 * len(episode.steps), 3.7), layout="constrained")
    FigureCanvasAgg(figure)
    for number, step in enumerate(episode.steps, start=1):
        axes = figure.add_subplot(1, len(episode.steps), number, aspect="equal")
        axes.set_title(f"{number}. {step.action.name}", fontsize=9)
        _draw_decision(axes, step)
        _draw_objects(axes, episode.scene, step)
        _draw_shelf(axes, episode.scene)
    figure.savefig(file, dpi=110)


def _draw_decision(axes: Any, step: Step) -> None:
    decision = PushDecision.of(step.decision)
    corridor, rectangle = decision.corridor, decision.rectangle
    if corridor is not None:
        low, high = corridor.axis - corridor.half_width, corridor.axis + corridor.half_width
        strip = [[corridor.start, low], [corridor.end, low], [corridor.end, high], [corridor.start, high]]
        axes.fill(*corridor.to_shelf(np.array(strip)).T, color="#dcebf7", zorder=0)
        if rectangle is not None:
            axes.fill(*corridor.to_shelf(rectangle.corners).T, fill=False, edgecolor="black", zorder=4)
    path = step.action.path.poses[:, :2]
    axes.plot(*path.T, color="black", linewidth=1.0, zorder=5)
    tail, head = path[-3], path[-2]  # the leg before the way out: the sweep, or the closing of the fingers
    axes.annotate("", head, tail, arrowprops={"arrowstyle": "-|>", "color": "black"}, zorder=5)


def _draw_objects(axes: Any, scene: Scene, step: Step) -> None:
    decision = PushDecision.of(step.decision)
    labels = dict(zip(decision.members, () if decision.labels is None else decision.labels, strict=False))
    for item, before, after in zip(scene.objects, step.before.poses, step.after.poses, strict=True):
        color = COMPONENTS[labels[item.id] % len(COMPONENTS)] if item.id in labels else OBSTACLE
        color = TARGET if item.id == scene.target else color
        axes.fill(*_outline(item.shape, before), color=color, zorder=2)
        axes.fill(*_outline(item.shape, after), fill=False, linestyle=":", edgecolor=color, zorder=3)


def _draw_shelf(axes: Any, scene: Scene) -> None:
    depth, width = scene.shelf.depth, scene.shelf.width
    axes.plot([0, depth, depth, 0], [0, 0, width, width], color="#444444", linewidth=2.0)
    axes.set(xlim=(-0.16, depth + 0.01), ylim=(-0.01, width + 0.01), xticks=[], yticks=[])
    axes.set_frame_on(False)


def _outline(shape: Shape, pose: FloatArray) -> FloatArray:
    """Its corners ``(2, k)`` in the shelf frame, seen from above."""
    corners = shape.outline
    return np.array([rotate(pose[3:], np.append(corner, 0.0))[:2] + pose[:2] for corner in corners]).T


if __name__ == "__main__":
    draw(phframe.solve("vieira/basic"), sys.argv[1] if len(sys.argv) > 1 else "decisions.png")
