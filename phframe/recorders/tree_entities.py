"""A search tree as a graph: what was tried from which state, the chosen path, and why the rest was closed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from textwrap import wrap

import numpy as np
import rerun as rr

from phframe.core import ROOT, ExploredTree, FloatArray, SearchNode
from phframe.core.explored_tree import path_to
from phframe.recorders import palette
from phframe.recorders.stream import Stream

TREE = "search/tree"
MOST_SHOWN = 60
"""Nodes that are drawn; of the rest only the number is."""
COLUMN, ROW = 190.0, 76.0
"""Between the nodes of a level and the next, and between two leaves (points, as text is measured in the view)."""
LETTERS = 24
"""In a line of a label."""


def log_tree(stream: Stream, tree: ExploredTree | None) -> None:
    """Draw a plan's search tree, from left to right; wipe it off where there is none."""
    shown = tree.summarised(MOST_SHOWN) if tree is not None else None
    nodes = () if shown is None else shown.nodes
    chosen = set() if shown is None else set(path_to(nodes, shown.chosen))
    rest = () if shown is None or not shown.omitted else (omitted_label(shown),)
    at = layout(nodes)
    graph = rr.GraphNodes(
        node_ids=[str(row) for row in range(len(nodes) + len(rest))],
        positions=np.vstack([at, *([0.0, at[:, 1].max() + ROW] for _ in rest)]),
        labels=[*(label(node) for node in nodes), *rest],
        colors=[*(_color(node, row in chosen) for row, node in enumerate(nodes)), *(palette.GREY_INK for _ in rest)],
        show_labels=True,
    )
    edges = [(str(node.parent), str(row)) for row, node in enumerate(nodes) if node.parent is not None]
    stream.put(TREE, graph, rr.GraphEdges(edges=edges, graph_type="directed"))


def label(node: SearchNode) -> str:
    """What led to a node, its value, and why it was closed."""
    name = node.action.name if node.action is not None else "start"
    value = "" if node.value is None else f"value {node.value + 0.0:g}"  # -0 is 0
    return "\n".join(line for text in (name, value, node.closed) for line in wrap(text, LETTERS))


def omitted_label(tree: ExploredTree) -> str:
    """How many nodes are not drawn, by why they were closed."""
    kinds = ", ".join(f"{number} {why}" for why, number in tree.omitted.items())
    return "\n".join(wrap(f"{sum(tree.omitted.values())} more: {kinds}", LETTERS))


def layout(nodes: Sequence[SearchNode]) -> FloatArray:
    """Places ``(n, 2)``: a column per level, a row per leaf, every other node in the middle of its children."""
    children: defaultdict[int, list[int]] = defaultdict(list)
    at = np.zeros((len(nodes), 2))
    for row, node in enumerate(nodes):
        if node.parent is not None:
            children[node.parent].append(row)
            at[row, 0] = at[node.parent, 0] + COLUMN
    for number, leaf in enumerate(_leaves(children) if nodes else ()):
        at[leaf, 1] = number * ROW
    for row in sorted(children, reverse=True):
        at[row, 1] = at[children[row], 1].mean()
    return at


def _leaves(children: defaultdict[int, list[int]]) -> Iterator[int]:
    """From the top down."""
    ahead = [ROOT]
    while ahead:
        row = ahead.pop()
        ahead.extend(reversed(children.get(row, ())))
        if row not in children:
            yield row


def _color(node: SearchNode, chosen: bool) -> palette.Color:
    if chosen:
        return palette.GREEN_INK
    return palette.RED_INK if node.closed else palette.BLUE_INK
