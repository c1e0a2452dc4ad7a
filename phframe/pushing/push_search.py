"""The search tree of planners that push until the target is free and then grasp it: trying pushes, going back, ending."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

from phframe.core import (
    ROOT,
    Action,
    Assessment,
    Attempt,
    Condition,
    Decision,
    Infeasible,
    Plan,
    State,
    Status,
    Task,
    Transition,
)
from phframe.pushing.deviation import Deviation
from phframe.pushing.grasp import Grasp
from phframe.pushing.options import PushingOptions
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.pushing import Pushing

UNCHANGED = 1e-3
"""No object moved more than this (m): the action failed."""

Proposal = tuple[PushDecision, Action]


class PushSearch:
    """What a planner of the family does at a node: see what stands there, try pushes, end with a grasp or a reason.

    Args:
        task: The task.
        options: The planner's.
        grasp_rounds: How often what blocks the grasp may be pushed aside on a path, once the corridor is empty.

    Attributes:
        pushing: The paper's geometry for the task.
        tree: All that was tried.
    """

    def __init__(self, task: Task, options: PushingOptions, grasp_rounds: int = 1) -> None:
        self.task, self.pushing, self._grasp_rounds = task, Pushing(task, options), grasp_rounds
        self.tree = task.search_tree()

    def state(self, node: int) -> State:
        """The state at a node."""
        return self.tree[node].state

    def next_step(self, node: int) -> PushProblem | Grasp | Infeasible:
        """What is to be done at a node: obstacles to be pushed, a grasp that nothing blocks, or why there is neither.

        Where the corridor is empty and objects beside the target block the grasp, these are the obstacles.
        """
        problem = self.pushing.problem(self.state(node))
        if isinstance(problem, Infeasible) or len(problem.members):
            return problem
        grasp = self.pushing.grasp(problem)
        if isinstance(grasp, Grasp) or not grasp.blockers or self._rounds(node) >= self._grasp_rounds:
            return grasp
        return self.pushing.problem(self.state(node), grasp.blockers)

    def try_push(self, node: int, decision: Decision, action: Action) -> int:
        """Simulate a push from a node; the index of the new one. One with a penalty is closed; see ``penalty``."""
        return self._add(node, decision, action, self.task.apply(self.state(node), action))

    def try_pushes(self, node: int, proposals: Iterable[Proposal]) -> list[int]:
        """The same for several pushes from one node; see ``try_frontier``."""
        return self.try_frontier((node, proposal) for proposal in proposals)

    def try_frontier(self, proposals: Iterable[tuple[int, Proposal]]) -> list[int]:
        """Simulate pushes from any nodes, by as many workers as there are; the new nodes, in the order of the pushes.

        Where the budget allows fewer simulations, only the first of them are made, whatever the number of workers.

        Raises:
            BudgetExceededError: If it allows none.
        """
        pushes, left = list(proposals), self.task.simulations_left
        pushes = pushes if left is None else pushes[: max(left, 1)]
        made = self.task.apply_many([(self.state(node), action) for node, (_, action) in pushes])
        return [self._add(node, *proposal, each) for (node, proposal), each in zip(pushes, made, strict=True)]

    def penalty(self, node: int) -> int:
        """0 where the push that led to a node did what it should; more for a spill, a stall, one that moved nothing."""
        found = self.tree[node]
        if found.parent is None or found.motion is None:
            return 0
        return _penalty(self.state(found.parent), Transition(found.state, found.motion))

    def take(self, node: int, *deviations: str) -> None:
        """Go on from a node all the same, noting by which deviations it was taken."""
        found = self.tree[node]
        decision = found.decision or Decision()
        self.tree.reopen(node, replace(decision, deviations=(*decision.deviations, *deviations)))

    def finish(self, node: int, step: Grasp | Infeasible) -> Plan:
        """The plan that ends at a node, where nothing is left to be pushed: with a grasp, or with why there is none."""
        return self.grasp(node, step) if isinstance(step, Grasp) else self.fail(node, step.reason)

    def grasp(self, node: int, grasp: Grasp) -> Plan:
        """The plan that ends with a grasp from a node, simulated and judged by the task's goal."""
        end, outcome = self.try_grasp(node, grasp)
        return self.tree.plan(end, outcome.status, outcome.reason)

    def grasp_early(self, node: int, problem: PushProblem) -> Plan | None:
        """The plan that ends with a grasp past the obstacles that are still in the corridor; None where that fails.

        It is simulated only where nothing blocks it; an attempt that fails stays in the tree, closed.
        """
        grasp = self.pushing.grasp(problem)
        if isinstance(grasp, Infeasible):
            return None
        early = replace(grasp, deviations=(*grasp.deviations, Deviation.GRASP_EARLY))
        end, outcome = self.try_grasp(node, early)
        if outcome.status is Status.RETRIEVED:
            return self.tree.plan(end, outcome.status, outcome.reason)
        self.tree.close(end, outcome.reason)
        return None

    def try_grasp(self, node: int, grasp: Grasp) -> tuple[int, Assessment]:
        """Simulate a grasp from a node: the index of the new one, and what the task's goal makes of it."""
        made = self.task.apply(self.state(node), grasp.action)
        decision = PushDecision("nothing blocks the grasp", grasp.deviations, corridor=grasp.corridor)
        end = self.tree.child(node, grasp.action, made, decision)
        return end, self.assess(grasp.action, made)

    def assess(self, action: Action, made: Transition) -> Assessment:
        """What the task's goal makes of an action."""
        return self.task.goal.assess(self.task.scene, made.state, Attempt(action, made.motion))

    def fail(self, node: int, reason: str) -> Plan:
        """The plan that ends at a node without success, and why; what was rejected before is told, too."""
        why = dict.fromkeys(each.reason for each in self.task.rejected)
        rejected = f" (rejected before: {'; '.join(why)})" if why else ""
        return self.tree.plan(node, Status.FAILED, reason + rejected)

    def exhausted(self, node: int, limit: str = "") -> Plan:
        """The plan that ends at a node without success, where nothing else is left to try, and how all the rest ended.

        Args:
            node: Where it got farthest.
            limit: What ended the search before everything was tried; empty: nothing did.
        """
        self.tree.close_others(node, "leads to no grasp")
        if why := self.tree[ROOT].closed:
            return self.fail(node, why)
        listed = ", ".join(f"{why} ({number})" for why, number in self._ends.most_common(3) if why)
        ended = f"; the search was ended by {limit}" if limit else ""
        return self.fail(
            node, f"none of {len(self.tree) - 1} simulated actions leads to a clean grasp: {listed}{ended}"
        )

    def hopeless(self, node: int, problem: PushProblem) -> str:
        """Why nothing more is to be pushed at a node, by the options ``max_actions`` and ``patience``; empty: go on."""
        options = self.pushing.options
        if (actions := self.tree.depth(node)) >= options.max_actions:
            return f"the corridor is not empty after {actions} actions"
        if (idle := self._idle_pushes(node, problem)) >= options.patience:
            return f"the last {idle} pushes took nothing out of the corridor"
        return ""

    def _idle_pushes(self, node: int, problem: PushProblem) -> int:
        """How many pushes ago, on the path to a node, the blocking obstacles were first as few as they ever were."""
        members = [len(PushDecision.of(each.decision).members) for each in self.tree.path(node)]
        left = [*members, len(problem.members)]
        return len(members) - left.index(min(left))

    @property
    def _ends(self) -> Counter[str]:
        """How often each reason closed a node that nothing follows."""
        nodes = [self.tree[row] for row in range(len(self.tree))]
        followed = {node.parent for node in nodes}
        return Counter(node.closed for row, node in enumerate(nodes) if row not in followed)

    def _rounds(self, node: int) -> int:
        """How often blockers of the grasp were pushed on the path to a node."""
        decisions = (each.decision for each in self.tree.path(node))
        return sum(Deviation.GRASP_BLOCKED in decision.deviations for decision in decisions if decision is not None)

    def _add(self, node: int, decision: Decision, action: Action, made: Transition) -> int:
        penalty = _penalty(self.state(node), made)
        return self.tree.child(node, action, made, decision, value=-float(penalty), closed=_fault(penalty, made))


def _penalty(before: State, made: Transition) -> int:
    return _fallen(before, made.state) + 100 * (not made.motion.complete) + 10000 * is_unchanged(before, made.state)


def _fallen(before: State, after: State) -> int:
    """How many objects toppled or left the board, of those that stood."""
    pairs = zip(before.conditions, after.conditions, strict=True)
    return sum(was is Condition.UPRIGHT and now is not Condition.UPRIGHT for was, now in pairs)


def _fault(penalty: int, made: Transition) -> str:
    if penalty >= 10000:
        return f"nothing moved{f': {made.motion.stopped}' if made.motion.stopped else ''}"
    if penalty >= 100:
        return str(made.motion.stopped or f"stalled at {made.motion.largest_force:.0f} N")
    return "something toppled or spilled" if penalty else ""


def by_direction(proposals: Iterable[Proposal]) -> list[list[Proposal]]:
    """The sweeps of one group by direction, each in the order they came in."""
    ways: dict[int, list[Proposal]] = {}
    for decision, action in proposals:
        ways.setdefault(0 if decision.sweep is None else decision.sweep.direction, []).append((decision, action))
    return list(ways.values())


def is_unchanged(before: State, after: State) -> bool:
    """Whether no object moved by more than a millimetre, which makes an action a failure (the paper's "unchanged")."""
    return bool((after.displacement(before) <= UNCHANGED).all())
