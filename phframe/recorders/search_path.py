"""The path of a search tree that a search got farthest on, as steps that were not carried out."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from phframe.core import ROOT, Decision, ExploredTree, Motion, SearchNode, Step, time_path
from phframe.core.explored_tree import path_to


def farthest_path(tree: ExploredTree) -> Iterator[tuple[Step, str]]:
    """The steps to the deepest node, the chosen one of several, and why the search did not go on from where each ends."""
    for before, after in pairwise(tree.nodes[row] for row in path_to(tree.nodes, _deepest(tree))):
        yield _step(before, after), after.closed


def _deepest(tree: ExploredTree) -> int:
    depths = [0] * len(tree.nodes)
    for row, node in enumerate(tree.nodes[1:], start=1):
        depths[row] = depths[node.parent or ROOT] + 1
    return max(range(len(depths)), key=lambda row: (depths[row], row == tree.chosen, row))


def _step(before: SearchNode, after: SearchNode) -> Step:
    assert after.action is not None, "every node but the root says what led to it"
    opening = 0.0 if before.state.arm is None else before.state.arm.opening
    motion, decision = after.motion or Motion(0.0), after.decision or Decision()
    limit = motion.largest_force or 1.0  # the limit itself is not told; any will do for what met nothing
    trajectory = time_path(after.action.path, opening, limit)
    return Step(after.action, trajectory, before.state, after.state, None, motion, decision, 0)
