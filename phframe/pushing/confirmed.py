"""A search tree as the engine that executes makes it come true, node by node."""

from __future__ import annotations

from dataclasses import replace

from phframe.core import ROOT, Action, ActionKind, Decision, State, Task, Transition
from phframe.pushing.harm import displacement_allowed, harm
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_search import PushSearch, is_unchanged


class Confirmed:
    """To each node of a search, the one that the engine which executes makes of it: beside it in the same tree.

    Args:
        task: The task; it must be able to confirm.
        search: Whose tree it is.
        harmful: Whether actions that do harm count as coming true.
    """

    def __init__(self, task: Task, search: PushSearch, *, harmful: bool = False) -> None:
        self._task, self._search, self._tree, self._harmful = task, search, search.tree, harmful
        self._held = {ROOT: task.start}  # states with the executing arm where it stands
        self._twins: dict[int, int | None] = {ROOT: ROOT}  # None: it does not come true

    def refutes(self, node: int) -> bool:
        """Whether something on the path to a node is known not to come true."""
        found: int | None = node
        while found is not None:
            if self._twins.get(found, ROOT) is None:
                return True
            found = self._tree[found].parent
        return False

    def of(self, node: int) -> int | None:
        """The node that the path to a node really leads to: itself, where it is one of these; None where it does not come true."""
        if node not in self._twins:
            self._twins[node] = self._confirm(node)
        return self._twins[node]

    def known(self, node: int) -> int:
        """The last node on the path to a node whose confirmed one is known, as that one; the node itself where none is."""
        found: int | None = node
        while found is not None:
            if (twin := self._twins.get(found)) is not None:
                return twin
            found = self._tree[found].parent
        return node

    def _confirm(self, node: int) -> int | None:
        planned = self._tree[node]
        if planned.parent is None or planned.action is None or (parent := self.of(planned.parent)) is None:
            return None
        twin, why = self.apply(parent, planned.action, planned.decision)
        if why:
            self._tree.close(node, f"when confirmed: {why}")
            return None
        self._twins[twin] = twin
        return twin

    def apply(self, parent: int, action: Action, decision: Decision | None) -> tuple[int, str]:
        """What an action makes of a confirmed node: the index of the new one, closed where it comes to harm; and why.

        Args:
            parent: The node: one that ``of`` returned.
            action: The action.
            decision: Why it is tried.
        """
        made = self._task.confirm(self._held[parent], action)
        why = self._harm(self._search.state(parent), action, made)
        given = PushDecision.of(decision)
        noted = replace(given, why=f"confirmed: {given.why}", confirmed=True)
        seen = Transition(made.state.for_another_arm(), made.motion)
        node = self._tree.child(parent, action, seen, noted, closed=why)
        self._held[node] = made.state
        return node, why

    def _harm(self, before: State, action: Action, made: Transition) -> str:
        scene = self._search.pushing.scene
        if action.kind is ActionKind.GRASP and (short := self._search.assess(action, made).reason):
            return short
        if not self._harmful and (why := harm(scene, before, made, displacement_allowed(scene, action))):
            return why
        return "nothing moved" if is_unchanged(before, made.state) else ""
