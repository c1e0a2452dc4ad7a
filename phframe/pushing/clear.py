"""The loop of PHIA and its simpler relatives (Algorithm 4): push the closest component until the target is free."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from phframe.core import Action, Decision, FloatArray, Infeasible, Plan, State, Status, Task, Transition
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import PushingOptions
from phframe.pushing.outcome import grasp_outcome
from phframe.pushing.push_problem import Pushing, PushProblem
from phframe.pushing.reach import Grasp

UNCHANGED = 1e-3
"""No object moved more than this (m): the action failed."""

ChooseRadius = Callable[[FloatArray, float], tuple[float, tuple[Deviation, ...]]]
"""From the finite deaths ``(k,)`` (m) and the threshold h (m) to the radius (m) and the deviations it needed."""


Tried = tuple[Decision, Action, Transition]


class Clearing:
    """One run of the loop for one task.

    Args:
        task: The task.
        options: The planner's.
        choose_radius: What tells one planner of this family from another.
    """

    def __init__(self, task: Task, options: PushingOptions, choose_radius: ChooseRadius) -> None:
        self._task, self._options, self._choose_radius = task, options, choose_radius
        self._pushing = Pushing(task, options)
        self._state = task.start
        self._actions: list[Action] = []
        self._expected: list[State] = []
        self._decisions: list[Decision] = []
        self._fewest, self._since_progress = len(task.scene.objects), 0

    def run(self) -> Plan:
        """Push until the corridor is empty, then grasp."""
        also: tuple[str, ...] = ()
        rounds_for_grasp = 1
        while True:
            problem = self._pushing.problem(self._state, also)
            if isinstance(problem, Infeasible):
                return self._failed(problem.reason)
            if len(problem.members):
                if failure := self._push(problem, blocked=bool(also)):
                    return self._failed(f"grasp blocked by {', '.join(also)}: {failure}" if also else failure)
                also = ()
                continue
            grasp = self._pushing.grasp(problem)
            if isinstance(grasp, Grasp):
                return self._grasp(problem, grasp)
            if not grasp.blockers or not rounds_for_grasp:
                return self._failed(grasp.reason)
            also, rounds_for_grasp = grasp.blockers, rounds_for_grasp - 1

    def _push(self, problem: PushProblem, *, blocked: bool) -> str | None:
        """Carry out one push; why not, where that fails."""
        if len(self._actions) >= self._options.max_actions:
            return f"the corridor is not empty after {len(self._actions)} actions"
        if self._since_progress >= self._options.patience:
            return f"the last {self._since_progress} pushes took nothing out of the corridor"
        diagram = self._pushing.diagram(problem)
        radius, deviations = self._choose_radius(diagram.finite_deaths, self._pushing.threshold)
        deviations = (*deviations, Deviation.GRASP_BLOCKED) if blocked else deviations
        tried = self._try_all(self._pushing.pushes(problem, diagram, radius, deviations))
        if tried is None:
            return "no sweep fits beside the closest component"
        decision, action, transition = tried
        if (transition.state.displacement(self._state) <= UNCHANGED).all():
            return f"nothing moved: {action.name}"
        self._keep(decision, action, transition)
        fewer = len(problem.members) < self._fewest
        self._fewest = min(self._fewest, len(problem.members))
        self._since_progress = 0 if fewer else self._since_progress + 1
        return None

    def _try_all(self, proposals: Iterator[tuple[Decision, Action]]) -> Tried | None:
        """Simulate the proposals in turn; the first that neither stalls nor spills, else the least bad of them."""
        best: tuple[int, Tried] | None = None
        for number, (decision, action) in enumerate(proposals):
            transition = self._task.apply(self._state, action)
            penalty = self._penalty(transition)
            if best is None or penalty < best[0]:
                deviations = (*decision.deviations, Deviation.NEXT_SWEEP) if number else decision.deviations
                best = penalty, (replace(decision, deviations=deviations), action, transition)
            if penalty == 0:
                break
        return best[1] if best else None

    def _penalty(self, transition: Transition) -> int:
        """0 where a push did what it should; more for a spill, a stall and a push that moved nothing."""
        spilled = int((self._state.on_board & ~transition.state.on_board).sum())
        unchanged = bool((transition.state.displacement(self._state) <= UNCHANGED).all())
        return spilled + 100 * (not transition.motion.complete) + 10000 * unchanged

    def _grasp(self, problem: PushProblem, grasp: Grasp) -> Plan:
        """The last action: reach, grasp, withdraw."""
        transition = self._task.apply(self._state, grasp.action)
        self._keep(Decision(corridor=problem.corridor, deviations=grasp.deviations), grasp.action, transition)
        motion, half_width = transition.motion, self._pushing.half_width
        path = grasp.action.path
        status, reason = grasp_outcome(
            self._task.scene, self._state, path, motion, at_pose=motion.complete, half_width=half_width
        )
        return self._plan(status, reason)

    def _keep(self, decision: Decision, action: Action, transition: Transition) -> None:
        parent = len(self._decisions) - 1 if self._decisions else None
        self._actions.append(action)
        self._expected.append(transition.state)
        self._decisions.append(replace(decision, parent=parent))
        self._state = transition.state

    def _failed(self, reason: str) -> Plan:
        return self._plan(Status.FAILED, reason)

    def _plan(self, status: Status, reason: str) -> Plan:
        return Plan(status, reason, tuple(self._actions), tuple(self._expected), tuple(self._decisions))
