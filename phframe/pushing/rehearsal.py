"""Plans rehearsed in samples of what the world may be, and the surest of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from phframe.core import ROOT, Action, ActionKind, Certainty, Decision, Particle, Plan, State, Status, Task, Transition
from phframe.pushing.harm import harm
from phframe.pushing.push_search import PushSearch


class Rehearsals:
    """Rehearses the plans that a search finds, and keeps the surest.

    Args:
        task: The task.
        search: The search.
        particles: Samples of the world in which a plan is rehearsed, where what is believed of it is uncertain.
        certain: Fraction of them in which it must be clean to be sure.
        most: How many plans are rehearsed.
    """

    def __init__(self, task: Task, search: PushSearch, *, particles: int, certain: float, most: int) -> None:
        self._task, self._search, self._tree = task, search, search.tree
        self._number, self._certain, self._left = particles, certain, most
        self._particles: tuple[Particle, ...] | None = None  # not drawn yet
        self._best: tuple[int, Certainty] | None = None
        self._unsure: set[int] = set()

    def rehearse(self, end: int, clearance: float | None) -> bool:
        """Rehearse the plan that ends at a node; whether the search can end, with the surest one so far.

        Args:
            end: The node, which a grasp leads to.
            clearance: That the arm keeps on its way in (m); None: not known.
        """
        if self._best is None:  # found already, should the budget end here
            self._task.offer(self._tree.plan(end, Status.RETRIEVED))
        actions = [node.action for node in self._tree.path(end) if node.action is not None]
        faults = [first_fault(self._search, actions, particle) for particle in self._samples()]
        certainty = Certainty(clearance, len(faults), faults.count(None))
        self._left -= 1
        if self._best is None or certainty.clean > self._best[1].clean:
            self._best = end, certainty
            self._task.offer(self._plan(*self._best))
        if not self._left or certainty.clean >= self._certain * certainty.samples:
            return True
        self._close_unsure(end, faults)
        return False

    def refutes(self, node: int) -> bool:
        """Whether no plan through a node is sure: what leads to it comes off in too few samples."""
        found: int | None = node if self._unsure else None
        while found is not None:
            if found in self._unsure:
                return True
            found = self._tree[found].parent
        return False

    def _close_unsure(self, end: int, faults: Sequence[int | None]) -> None:
        """Close the first node on the way to the end of a plan that too few samples reach without a fault."""
        for number, node in enumerate(self._tree.rows(end)):
            reached = sum(fault is None or fault > number for fault in faults)
            if reached < self._certain * len(faults):
                self._unsure.add(node)
                self._tree.close(node, f"comes off in {reached} of {len(faults)} samples of the world")
                return

    def surest(self) -> Plan | None:
        """The surest plan; None: there is none."""
        if self._best is None:
            return None
        end, certainty = self._best
        for row in (ROOT, *self._tree.rows(end)):
            if self._tree[row].closed:
                self._tree.reopen(row, self._tree[row].decision or Decision())
        self._tree.close_others(end, "another path led to a clean grasp")
        return self._plan(end, certainty)

    def _samples(self) -> tuple[Particle, ...]:
        if self._particles is None:
            self._particles = self._task.particles(self._number)
        return self._particles

    def _plan(self, end: int, certainty: Certainty) -> Plan:
        return replace(self._tree.plan(end, Status.RETRIEVED), certainty=certainty)


def first_fault(search: PushSearch, actions: Sequence[Action], particle: Particle) -> int | None:
    """Which action of a plan, simulated open loop in a sample, does harm or does not take the target out; None: none.

    Args:
        search: For whose task it is.
        actions: The plan's.
        particle: The sample.
    """
    state = particle.start
    for number, action in enumerate(actions):
        made = particle.apply(state, action, None)
        if _fault(search, action, state, made):
            return number
        state = made.state
    return None


def _fault(search: PushSearch, action: Action, before: State, made: Transition) -> str:
    if action.kind is ActionKind.GRASP and (why := search.assess(action, made).reason):
        return why
    return harm(search.pushing.scene, before, made, None)
