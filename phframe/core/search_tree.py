"""The search tree of a planner: what was tried from which state, what became of it, and which path was chosen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from phframe.core.action import Action
from phframe.core.decision import AnyDecision, Decision
from phframe.core.errors import InputError
from phframe.core.motion import Motion, Transition
from phframe.core.state import State
from phframe.core.value import Value

ROOT = 0
"""Index of the root among a tree's nodes."""
MOST_NODES = 500
"""Nodes of a tree that a file holds; what is left out is counted."""


@dataclass(frozen=True, slots=True, eq=False)
class SearchNode(Value):
    """A state that a search has seen.

    Attributes:
        state: The state.
        parent: Index of the node it comes from; None: it is the root.
        action: What leads here from the parent.
        motion: What happened on the way.
        decision: Why the action was tried.
        value: What the planner thinks of it, in units of its own; None: nothing.
        closed: Why it is looked at no further; empty: it is open, or on the chosen path.
    """

    state: State
    parent: int | None = None
    action: Action | None = None
    motion: Motion | None = None
    decision: AnyDecision | None = None
    value: float | None = None
    closed: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class ExploredTree(Value):
    """A search tree that has stopped growing: what a plan carries.

    Attributes:
        nodes: Every node comes after its parent; the first is the root.
        chosen: Index of the node at which the plan's path ends.
        omitted: How many further nodes there were, by why they were closed; empty: none.

    Raises:
        InputError: If a parent does not come before its child, or there is no such chosen node.
    """

    nodes: tuple[SearchNode, ...]
    chosen: int = ROOT
    omitted: Mapping[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.nodes or not 0 <= self.chosen < len(self.nodes):
            raise InputError(f"a search tree of {len(self.nodes)} nodes has no node {self.chosen}")
        for number, node in enumerate(self.nodes):
            _check(number, node)

    @property
    def path(self) -> tuple[SearchNode, ...]:
        """The nodes of the chosen path, the root left out."""
        return tuple(self.nodes[row] for row in path_to(self.nodes, self.chosen)[1:])

    def summarised(self, most: int = MOST_NODES) -> ExploredTree:
        """The tree with no more than so many nodes: the chosen path, then the others in the order they were tried."""
        if len(self.nodes) <= most:
            return self
        kept = set(path_to(self.nodes, self.chosen))
        for row, node in enumerate(self.nodes):
            if len(kept) >= most:
                break
            if node.parent in kept:
                kept.add(row)
        order = {row: number for number, row in enumerate(sorted(kept))}
        nodes = tuple(
            replace(self.nodes[row], parent=None if row == ROOT else order[self.nodes[row].parent or ROOT])
            for row in order
        )
        left_out = Counter(node.closed or "open" for row, node in enumerate(self.nodes) if row not in kept)
        return ExploredTree(nodes, order[self.chosen], dict(Counter(self.omitted) + left_out))


def _check(number: int, node: SearchNode) -> None:
    if node.parent not in ((None,) if number == ROOT else range(number)):
        raise InputError(f"node {number} of a search tree cannot have the parent {node.parent}")
    if number != ROOT and (node.action is None or node.decision is None):
        raise InputError(f"node {number} of a search tree does not say what led to it, or why")


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

    def path(self, node: int) -> tuple[SearchNode, ...]:
        """The nodes that lead to a node, the root left out."""
        return tuple(self._nodes[row] for row in path_to(self._nodes, node)[1:])

    def explored(self, node: int) -> ExploredTree:
        """The tree as it is now, with the path to a node as the chosen one."""
        return ExploredTree(tuple(self._nodes), node)


def path_to(nodes: Sequence[SearchNode], node: int) -> list[int]:
    """Indices of the nodes from the root to one of them."""
    return list(_upwards(nodes, node))[::-1]


def _upwards(nodes: Sequence[SearchNode], node: int) -> Iterator[int]:
    row: int | None = node
    while row is not None:
        yield row
        row = nodes[row].parent
