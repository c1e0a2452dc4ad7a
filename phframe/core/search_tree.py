"""A search tree that grows as a planner searches, and the plan that comes of it."""

from __future__ import annotations

from dataclasses import replace

from phframe.core.action import Action
from phframe.core.decision import Decision
from phframe.core.explored_tree import ROOT, ExploredTree, SearchNode, path_to
from phframe.core.motion import Transition
from phframe.core.plan import Plan
from phframe.core.state import State
from phframe.core.status import Status


class SearchTree:
    """A tree that grows as a planner searches. Nodes are known by their index, in the order they were added.

    A planner goes on from any node (that is all there is to back-tracking), and the path to one of them is its plan::

        tree = SearchTree(task.start)
        node = tree.child(ROOT, action, task.apply(task.start, action), decision)
        return tree.plan(node, Status.FAILED, "nothing else to try")

    Args:
        root: The state that the search begins with.
    """

    def __init__(self, root: State) -> None:
        self._nodes = [SearchNode(root)]

    def __len__(self) -> int:
        return len(self._nodes)

    def __getitem__(self, node: int) -> SearchNode:
        return self._nodes[node]

    def child(
        self,
        parent: int,
        action: Action,
        made: Transition,
        decision: Decision = Decision(),  # noqa: B008 - immutable
        *,
        value: float | None = None,
        closed: str = "",
    ) -> int:
        """Add what an action made of a node; returns the index of the new one."""
        self._nodes.append(SearchNode(made.state, parent, action, made.motion, decision, value, closed))
        return len(self._nodes) - 1

    def close(self, node: int, why: str) -> None:
        """Say why a node is looked at no further."""
        self._nodes[node] = replace(self._nodes[node], closed=why)

    def close_others(self, node: int, why: str) -> None:
        """Close every node that is still open, but for a node and those that lead to it; say why they are looked at no further."""
        for row in set(range(len(self._nodes))) - set(path_to(self._nodes, node)):
            if not self._nodes[row].closed:
                self.close(row, why)

    def reopen(self, node: int, decision: Decision) -> None:
        """Go on from a node after all, for a reason that its decision now tells."""
        self._nodes[node] = replace(self._nodes[node], closed="", decision=decision)

    def rate(self, node: int, value: float) -> None:
        """Say what a node is worth."""
        self._nodes[node] = replace(self._nodes[node], value=value)

    def depth(self, node: int) -> int:
        """How many actions lead to a node."""
        return len(path_to(self._nodes, node)) - 1

    @property
    def deepest(self) -> int:
        """The node to which most actions lead, of several the last one added."""
        depths = [0] * len(self._nodes)
        for row, node in enumerate(self._nodes[1:], start=1):
            depths[row] = depths[node.parent or ROOT] + 1
        return max(range(len(depths)), key=lambda row: (depths[row], row))

    def rows(self, node: int) -> tuple[int, ...]:
        """The indices of the nodes that lead to a node, the root left out."""
        return tuple(path_to(self._nodes, node)[1:])

    def path(self, node: int) -> tuple[SearchNode, ...]:
        """The nodes that lead to a node, the root left out."""
        return tuple(self._nodes[row] for row in self.rows(node))

    def plan(self, node: int, status: Status, reason: str = "") -> Plan:
        """The plan that consists of the actions which lead to a node, with all that was tried.

        Args:
            node: Where the plan ends.
            status: How far it is expected to get.
            reason: Why no farther, for people; empty where the goal is met.
        """
        return Plan(status, reason, self.explored(node))

    def explored(self, node: int) -> ExploredTree:
        """The tree as it is now, with the path to a node as the chosen one."""
        return ExploredTree(tuple(self._nodes), node)
