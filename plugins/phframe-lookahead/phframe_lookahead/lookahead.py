"""Lookahead: of all sweeps, the one after which the fewest obstacles are in the way."""

from __future__ import annotations

import math
from collections.abc import Iterator

from phframe.core import ROOT, Plan, Planner, Task
from phframe.pushing import Grasp, Proposal, PushingOptions, PushProblem, PushSearch


class Lookahead(Planner[PushingOptions]):
    """Simulates the sweeps of every group at every usable radius and of every single obstacle, and takes the best one.

    The best one leaves the fewest obstacles in the way; of several, it takes the least time. One that stalls, topples or
    spills something or moves nothing is not taken. ``max_actions`` and ``patience`` end the search.
    """

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Greedy, by simulation: one push ahead, from wherever the last one led."""
        search, node = PushSearch(task, self.options), ROOT
        while isinstance(step := search.next_step(node), PushProblem):
            if why := search.hopeless(node, step):
                return search.fail(node, why)
            tried = search.try_pushes(node, different(sweeps(search, step)))
            ranks = {child: rank(search, child) for child in tried if search.penalty(child) == 0}
            if not ranks:
                return search.fail(node, f"none of {len(tried)} sweeps is safe and moves anything")
            node = min(ranks, key=lambda child: ranks[child])
        search.tree.close_others(node, "leaves more in the way, or takes longer")
        return search.finish(node, step)


def sweeps(search: PushSearch, problem: PushProblem) -> Iterator[Proposal]:
    """The sweeps that fit of each group at each usable radius, and of each obstacle alone."""
    pushing = search.pushing
    for radius in [0.0, *pushing.radii(pushing.diagram(problem))]:
        labels = pushing.components(problem, radius)
        for label in range(int(labels.max()) + 1):
            yield from pushing.sweeps(problem, (labels == label).nonzero()[0])


def different(proposals: Iterator[Proposal]) -> list[Proposal]:
    """Those whose path is not that of an earlier one."""
    return list({action.path.poses.tobytes(): (decision, action) for decision, action in proposals}.values())


def rank(search: PushSearch, node: int) -> tuple[float, float]:
    """How many obstacles are in the way at a node, and how long the push took that led there (s); less is better."""
    step, motion = search.next_step(node), search.tree[node].motion
    left = len(step.members) if isinstance(step, PushProblem) else 0 if isinstance(step, Grasp) else math.inf
    return left, 0.0 if motion is None else motion.duration
