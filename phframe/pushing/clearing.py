"""The loop of PHIA and its simpler relatives (Algorithm 4): push the closest component until the target is free."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from phframe.core import ROOT, FloatArray, Plan, Task
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import ClearingOptions
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.push_search import Proposal, PushSearch, is_unchanged

ChooseRadius = Callable[[FloatArray, float], tuple[float, tuple[Deviation, ...]]]
"""From the finite deaths ``(k,)`` (m) and the threshold h (m) to the radius (m) and the deviations it needed."""


class Clearing:
    """One run of the loop for one task: greedy, one push per configuration.

    Args:
        task: The task.
        options: The planner's.
        choose_radius: What tells one planner of this family from another.
    """

    def __init__(self, task: Task, options: ClearingOptions, choose_radius: ChooseRadius) -> None:
        self._options, self._choose_radius = options, choose_radius
        self._search = PushSearch(task, options)
        self._pushing, self._tree = self._search.pushing, self._search.tree
        self._fewest, self._since_progress = len(task.scene.objects), 0

    def run(self) -> Plan:
        """Push until the corridor is empty, then grasp."""
        node = ROOT
        while isinstance(step := self._search.next_step(node), PushProblem):
            if self._options.grasp_first and (plan := self._search.grasp_early(node, step)) is not None:
                return plan
            pushed = self._push(node, step)
            if isinstance(pushed, str):
                blocked = f"grasp blocked by {', '.join(step.blockers)}: " if step.blockers else ""
                return self._search.fail(node, blocked + pushed)
            node = pushed
        return self._search.finish(node, step)

    def _push(self, node: int, problem: PushProblem) -> int | str:
        """Go on from a node by one push; why not, where that fails."""
        if (actions := self._tree.depth(node)) >= self._options.max_actions:
            return f"the corridor is not empty after {actions} actions"
        if self._since_progress >= self._options.patience:
            return f"the last {self._since_progress} pushes took nothing out of the corridor"
        diagram = self._pushing.diagram(problem)
        radius, deviations = self._choose_radius(diagram.finite_deaths, self._pushing.threshold)
        pushed = self._best(node, self._pushing.pushes(problem, diagram, radius, deviations))
        if pushed is None:
            return "no sweep fits beside the closest component"
        if is_unchanged(self._search.state(node), self._search.state(pushed)):
            action = self._tree[pushed].action
            return f"nothing moved: {action.name if action else ''}"
        self._note_progress(len(problem.members))
        return pushed

    def _best(self, node: int, proposals: Iterator[Proposal]) -> int | None:
        """Simulate the proposals in turn; the first that neither stalls nor spills, else the one of least penalty."""
        best: int | None = None
        first: int | None = None
        for decision, action in proposals:
            tried = self._search.try_push(node, decision, action)
            first = tried if first is None else first
            if best is None or self._search.penalty(tried) < self._search.penalty(best):
                best = tried
            if self._search.penalty(tried) == 0:
                break
        if best is not None:
            self._search.take(best, *(() if best == first else (Deviation.NEXT_SWEEP,)))
        return best

    def _note_progress(self, members: int) -> None:
        """Count the pushes since the obstacles last became fewer."""
        fewer = members < self._fewest
        self._fewest = min(self._fewest, members)
        self._since_progress = 0 if fewer else self._since_progress + 1
