"""Draws what a planner tried, one panel per node of its search tree: ``draw(scene, plan, "search.png")``."""

import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import phframe
from phframe.core import ExploredTree, FloatArray, Plan, Scene, SearchNode, Shape, rotate

COLUMNS = 5
CHOSEN, DEAD_END, OPEN = "#2e9e5b", "#c0392b", "#8d99a6"
TARGET, OBSTACLE = "#f0a020", "#c3cad2"


def draw(scene: Scene, plan: Plan, file: str | Path) -> None:
    """Draw every node in the order it was tried: where things were (dashed) and are, the gripper's path, why it was closed."""
    tree = plan.tree
    if tree is None or len(tree.nodes) < 2:
        raise SystemExit("the plan has no search tree to be drawn")
    rows = -(-(len(tree.nodes) - 1) // COLUMNS)
    figure = Figure(figsize=(2.7 * COLUMNS, 3.2 * rows), layout="constrained")
    FigureCanvasAgg(figure)
    for number in range(1, len(tree.nodes)):
        axes = figure.add_subplot(rows, COLUMNS, number, aspect="equal")
        _draw_node(axes, scene, tree, number)
    figure.savefig(file, dpi=100)


def _draw_node(axes: Any, scene: Scene, tree: ExploredTree, number: int) -> None:
    node = tree.nodes[number]
    before = tree.nodes[node.parent or 0].state
    color = _color(tree, node)
    for item, was, now in zip(scene.objects, before.poses, node.state.poses, strict=True):
        fill = TARGET if item.id == scene.target else OBSTACLE
        axes.fill(*_outline(item.shape, was), fill=False, linestyle=":", edgecolor="#5c6670", zorder=2)
        axes.fill(*_outline(item.shape, now), color=fill, zorder=1)
    if node.action is not None:
        path = node.action.path.poses[:, :2]
        axes.plot(*path.T, color=color, linewidth=1.4, zorder=3)
        axes.annotate("", path[-2], path[-3], arrowprops={"arrowstyle": "-|>", "color": color}, zorder=3)
    _draw_shelf(axes, scene, color)
    parent = f" after {node.parent}" if node.parent else ""
    told = f"{number}{parent}: {node.action.name if node.action else ''}. {node.closed or 'chosen'}"
    axes.set_title("\n".join(textwrap.wrap(told, 40)[:4]), fontsize=7, color=color)


def _color(tree: ExploredTree, node: SearchNode) -> str:
    if any(node is each for each in tree.path):
        return CHOSEN
    return OPEN if node.closed.startswith("another path") else DEAD_END


def _draw_shelf(axes: Any, scene: Scene, color: str) -> None:
    depth, width = scene.shelf.depth, scene.shelf.width
    axes.plot([0, depth, depth, 0], [0, 0, width, width], color=color, linewidth=2.0)
    axes.set(xlim=(-0.16, depth + 0.01), ylim=(-0.01, width + 0.01), xticks=[], yticks=[])
    axes.set_frame_on(False)


def _outline(shape: Shape, pose: FloatArray) -> FloatArray:
    """Its corners ``(2, k)`` in the shelf frame, seen from above."""
    corners = shape.outline
    return np.array([rotate(pose[3:], np.append(corner, 0.0))[:2] + pose[:2] for corner in corners]).T


if __name__ == "__main__":
    EPISODE = phframe.solve("papallas/s08", planner="sure")
    draw(EPISODE.scene, EPISODE.plans[0], sys.argv[1] if len(sys.argv) > 1 else "search.png")
