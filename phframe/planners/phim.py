"""PHIM: persistent homology informed Monte-Carlo tree search (Vieira et al. 2022b)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated

from pydantic import Field

from phframe.core import ROOT, Assessment, Infeasible, Plan, Planner, Task
from phframe.pushing import Grasp, Proposal, PushingOptions, PushProblem, PushSearch, by_direction


class PHIMOptions(PushingOptions):
    """The shared ones, and those of the tree search.

    Attributes:
        iterations: Pushes simulated before each action is chosen.
        exploration: c in ``mean + c sqrt(log N / n)``, how much it counts that a node was seldom visited (obstacles).
    """

    iterations: Annotated[int, Field(ge=1, le=100_000)] = 15
    exploration: Annotated[float, Field(ge=0.0, le=1000.0)] = 1.0


class PHIM(Planner[PHIMOptions]):
    """Monte-Carlo tree search over the sweeps of the closest component, at all usable radii and in both directions."""

    options_type = PHIMOptions

    def search(self, task: Task) -> Plan:
        """Choose one action after another, each after so many iterations, until a path ends with a grasp: that is the plan."""
        return _MonteCarloTree(task, self.options).run()


def upper_confidence_bound(mean: float, visits: int, parent_visits: int, exploration: float) -> float:
    """``mean + c sqrt(log N / n)``: what a node may be worth at best (UCB1).

    Args:
        mean: Of its rewards.
        visits: Its own, n, at least 1.
        parent_visits: Its parent's, N, at least n.
        exploration: c.
    """
    return mean + exploration * math.sqrt(math.log(parent_visits) / visits)


@dataclass(slots=True)
class _Visits:
    """What is known of a node.

    Attributes:
        untried: Pushes that were not simulated yet.
        children: The nodes that those simulated led to.
        members: Blocking obstacles.
        components: Of these, at the threshold h.
        visits: How often a push was tried here or further down, n.
        reward: What these pushes brought, in all.
    """

    untried: list[Proposal] = field(default_factory=list)
    children: list[int] = field(default_factory=list)
    members: int = 0
    components: int = 0
    visits: int = 0
    reward: float = 0.0

    @property
    def mean(self) -> float:
        """Mean reward of the visits."""
        return self.reward / self.visits if self.visits else 0.0


class _MonteCarloTree:
    """One search. A node's value is the mean reward of its visits."""

    def __init__(self, task: Task, options: PHIMOptions) -> None:
        self._task, self._options = task, options
        self._search = PushSearch(task, options)
        self._tree = self._search.tree
        self._known: dict[int, _Visits] = {}
        self._best: tuple[int, Assessment] | None = None
        self._failed_grasp: tuple[int, Assessment] | None = None

    def run(self) -> Plan:
        """So many iterations for each action, from where the last one led; back where nothing is left to try."""
        base, actions = ROOT, 0
        self._look_at(ROOT)
        while self._best is None and not self._finished(ROOT) and actions < self._options.max_actions:
            base, actions = self._chosen(base), actions + 1
            self._iterate(base)
        return self._result(base)

    def _iterate(self, base: int) -> None:
        """From a node down: select, try a push, pass its reward on."""
        for _ in range(self._options.iterations):
            if self._finished(base):
                return
            node = self._select(base)
            child = self._search.try_push(node, *self._known[node].untried.pop(0))
            self._known[node].children.append(child)
            self._look_at(child)
            self._pass_on(child, self._reward(node, child))

    def _select(self, node: int) -> int:
        """The first node with an untried push on the way down by the greatest upper confidence bounds."""
        while not (here := self._known[node]).untried:
            bounds = {child: self._bound(child, here.visits) for child in self._open_children(node)}
            node = max(bounds, key=lambda child: bounds[child])
        return node

    def _bound(self, child: int, parent_visits: int) -> float:
        known = self._known[child]
        return upper_confidence_bound(known.mean, known.visits, parent_visits, self._options.exploration)

    def _open_children(self, node: int) -> list[int]:
        return [child for child in self._known[node].children if not self._finished(child)]

    def _finished(self, node: int) -> bool:
        """Whether nothing is left to try at a node or further down."""
        return not self._known[node].untried and not self._open_children(node)

    def _pass_on(self, child: int, reward: float) -> None:
        """Add a reward to a node and to all that lead to it."""
        node: int | None = child
        while node is not None:
            known = self._known[node]
            known.visits, known.reward = known.visits + 1, known.reward + reward
            self._tree.rate(node, known.mean)
            node = self._tree[node].parent

    def _reward(self, parent: int, child: int) -> float:
        """Obstacles taken out of the way and, unless these are less than none, components gained; 0 if it was not safe."""
        if self._tree[child].closed:
            return 0.0
        before, after = self._known[parent], self._known[child]
        removed, gained = before.members - after.members, after.components - before.components
        return float(removed + gained if removed >= 0 else removed)

    def _look_at(self, node: int) -> None:
        """See what can be done at a new node: pushes to be tried, or a grasp, which is simulated at once."""
        known = self._known[node] = _Visits()
        if self._tree[node].closed:
            return
        step = self._search.next_step(node)
        if isinstance(step, Grasp):
            self._grasp(node, step)
        elif why := step.reason if isinstance(step, Infeasible) else self._search.hopeless(node, step):
            self._tree.close(node, why)
        elif isinstance(step, PushProblem):
            known.members, known.components = len(step.members), self._components(step)
            known.untried = self._proposals(step)
            if not known.untried:
                self._tree.close(node, "no sweep fits beside the closest component")

    def _components(self, problem: PushProblem) -> int:
        """How many groups there are that something fits between."""
        return len(set(self._search.pushing.components(problem, self._search.pushing.threshold).tolist()))

    def _proposals(self, problem: PushProblem) -> list[Proposal]:
        """The best sweep of the closest component in each direction, at each radius; of those alike only the first."""
        found: dict[bytes, Proposal] = {}
        for sweeps in self._search.pushing.pushes_at_all_radii(problem):
            for (_, action), decision in ((way[0], way[0][0]) for way in by_direction(sweeps)):
                found.setdefault(action.path.poses.tobytes(), (decision, action))
        return list(found.values())

    def _grasp(self, node: int, grasp: Grasp) -> None:
        """Grasp; the shortest path that ends in one counts, of several the one found first."""
        end, outcome = self._search.try_grasp(node, grasp)
        if not outcome.status.is_success:
            self._tree.close(end, outcome.reason)
            self._failed_grasp = self._failed_grasp or (end, outcome)
        elif self._best is None or self._tree.depth(end) < self._tree.depth(self._best[0]):
            self._best = (end, outcome)
            self._task.offer(self._tree.plan(end, outcome.status, outcome.reason))

    def _chosen(self, base: int) -> int:
        """What to go on from: the child of most visits, the one of the greater mean first; back from a dead end."""
        while self._finished(base) and base != ROOT:
            base = self._tree[base].parent or ROOT
        ranks = {child: (self._known[child].visits, self._known[child].mean) for child in self._open_children(base)}
        return max(ranks, key=lambda child: ranks[child], default=base)

    def _result(self, base: int) -> Plan:
        """The plan of the best path, else of one whose grasp does not succeed, else how far it got."""
        if (found := self._best or self._failed_grasp) is None:
            return self._search.exhausted(
                base, "" if self._finished(ROOT) else f"max_actions={self._options.max_actions}"
            )
        end, outcome = found
        self._tree.close_others(end, "not on the path that was chosen")
        return self._tree.plan(end, outcome.status, outcome.reason)
