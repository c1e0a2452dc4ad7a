"""A search tree that has stopped growing: what was tried from which state, what became of it, which path was chosen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from phframe.core.action import Action
from phframe.core.decision import AnyDecision
from phframe.core.errors import InputError
from phframe.core.motion import Motion
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
        closed: Why it is looked at no further; empty: it is open, or on the path of a plan that succeeds.
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

    def after(self, actions: int) -> ExploredTree:
        """The part of the tree that begins after so many actions of the chosen path; the rest of the path is its chosen one."""
        node = path_to(self.nodes, self.chosen)[actions]
        order = {node: ROOT}
        for row, each in enumerate(self.nodes):
            if each.parent in order:
                order[row] = len(order)
        nodes = tuple(
            replace(self.nodes[row], parent=None if row == node else order[self.nodes[row].parent or ROOT])
            for row in order
        )
        return ExploredTree(nodes, order[self.chosen])

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


def path_to(nodes: Sequence[SearchNode], node: int) -> list[int]:
    """Indices of the nodes from the root to one of them."""
    return list(_upwards(nodes, node))[::-1]


def _upwards(nodes: Sequence[SearchNode], node: int) -> Iterator[int]:
    row: int | None = node
    while row is not None:
        yield row
        row = nodes[row].parent
