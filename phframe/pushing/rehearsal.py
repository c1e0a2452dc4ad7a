"""Plans rehearsed in samples of what the world may be, and the surest of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from phframe.core import Action, ActionKind, Certainty, Decision, Particle, Plan, State, Status, Task, Transition
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

    def rehearse(self, end: int, clearance: float | None) -> bool:
        """Rehearse the plan that ends at a node; whether the search can end, with the surest one so far.

        Args:
            end: The node, which a grasp leads to.
            clearance: That the arm keeps on its way in (m); None: not known.
        """
        if self._best is None:  # found already, should the budget end here
            self._task.offer(self._tree.plan(end, Status.RETRIEVED))
        actions = [node.action for node in self._tree.path(end) if node.action is not None]
        certainty = rehearsed(self._search, actions, self._samples(), clearance)
        self._left -= 1
        if self._best is None or certainty.clean > self._best[1].clean:
            self._best = end, certainty
            self._task.offer(self._plan(*self._best))
        if not self._left or certainty.clean >= self._certain * certainty.samples:
            return True
        self._tree.close(end, f"clean in {certainty.clean} of {certainty.samples} samples of the world")
        return False

    def surest(self) -> Plan | None:
        """The surest plan; None: there is none."""
        if self._best is None:
            return None
        end, certainty = self._best
        self._tree.reopen(end, self._tree[end].decision or Decision())
        self._tree.close_others(end, "another path led to a clean grasp")
        return self._plan(end, certainty)

    def _samples(self) -> tuple[Particle, ...]:
        if self._particles is None:
            self._particles = self._task.particles(self._number)
        return self._particles

    def _plan(self, end: int, certainty: Certainty) -> Plan:
        return replace(self._tree.plan(end, Status.RETRIEVED), certainty=certainty)


def rehearsed(
    search: PushSearch, actions: Sequence[Action], particles: Sequence[Particle], clearance: float | None = None
) -> Certainty:
    """Simulate a plan in every sample, open loop, and count those in which it retrieves the target cleanly.

    Args:
        search: For whose task it is.
        actions: The plan's.
        particles: The samples.
        clearance: That the arm keeps on its way in (m); None: not known.
    """
    clean = sum(_comes_off(search, actions, particle) for particle in particles)
    return Certainty(clearance, len(particles), clean)


def _comes_off(search: PushSearch, actions: Sequence[Action], particle: Particle) -> bool:
    state = particle.start
    for action in actions:
        made = particle.apply(state, action, None)
        if _fault(search, action, state, made):
            return False
        state = made.state
    return True


def _fault(search: PushSearch, action: Action, before: State, made: Transition) -> str:
    if action.kind is ActionKind.GRASP and (why := search.assess(action, made).reason):
        return why
    return harm(search.pushing.scene, before, made, None)
