"""Random push: the floor that every other planner must beat."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from phframe.core import Action, Decision, Infeasible, Plan, Planner, State, Status, Task
from phframe.pushing.clear import UNCHANGED
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import PushingOptions
from phframe.pushing.outcome import grasp_outcome
from phframe.pushing.push_problem import Pushing, PushProblem

Proposal = tuple[Decision, Action]


class RandomPush(Planner[PushingOptions]):
    """Sweeps a random obstacle of the corridor, alone, in a random direction, until the target is free.

    A sweep that moves nothing is left out of the plan, but counts as one of the ``max_actions`` attempts.
    """

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Sweep at random until the gripper can grasp the target."""
        return _Search(task, self.options).run()


@dataclass(slots=True)
class _Progress:
    """The plan so far, and the state it leads to."""

    state: State
    steps: list[tuple[Decision, Action, State]] = field(default_factory=list)

    def add(self, decision: Decision, action: Action, state: State) -> None:
        self.steps.append((decision, action, state))
        self.state = state

    @property
    def last(self) -> int | None:
        """Index of the last decision."""
        return len(self.steps) - 1 if self.steps else None

    def plan(self, status: Status, reason: str = "") -> Plan:
        decisions, actions, expected = zip(*self.steps, strict=True) if self.steps else ((), (), ())
        return Plan(status, reason, actions, expected, decisions)


class _Search:
    """One run for one task."""

    def __init__(self, task: Task, options: PushingOptions) -> None:
        self._task, self._options = task, options
        self._pushing = Pushing(task, options)
        self._progress = _Progress(task.start)

    def run(self) -> Plan:
        """Sweep until the corridor is empty and nothing keeps the fingers from the target; then grasp."""
        blockers: tuple[str, ...] = ()
        for _ in range(self._options.max_actions):
            problem = self._pushing.problem(self._progress.state, blockers)
            if not isinstance(problem, Infeasible) and len(problem.members) == 0:
                grasp = self._grasp(problem)
                if isinstance(grasp, Plan):
                    return grasp
                blockers = grasp.blockers
                problem = self._pushing.problem(self._progress.state, blockers) if blockers else grasp
            if isinstance(problem, Infeasible):
                return self._progress.plan(Status.FAILED, problem.reason)
            proposal = self._propose(problem)
            if proposal is None:
                return self._progress.plan(Status.FAILED, "no sweep fits beside any obstacle")
            if self._sweep(*proposal):
                blockers = ()
        return self._after_the_last_attempt()

    def _after_the_last_attempt(self) -> Plan:
        """The grasp, if the last sweep freed the target."""
        problem = self._pushing.problem(self._progress.state)
        if not isinstance(problem, Infeasible) and len(problem.members) == 0:
            grasp = self._grasp(problem)
            if isinstance(grasp, Plan):
                return grasp
        return self._progress.plan(Status.FAILED, f"the target is not free; attempts made: {self._options.max_actions}")

    def _propose(self, problem: PushProblem) -> Proposal | None:
        """A random direction of the first obstacle, in random order, beside which a sweep fits."""
        for member in self._task.rng.permutation(len(problem.members)):
            proposals = self._proposals(problem, int(member))
            if proposals:
                return proposals[self._task.rng.integers(len(proposals))]
        return None

    def _proposals(self, problem: PushProblem, member: int) -> list[Proposal]:
        """The best sweep of one obstacle in each direction, if one fits that was not rejected."""
        best: dict[int, Proposal] = {}
        for decision, action in self._pushing.sweeps(problem, np.array([member])):
            sweep = decision.sweep
            assert sweep is not None, "a sweep's decision says which"
            # Here chance settles the direction, not the paper's silence.
            deviations = tuple(deviation for deviation in decision.deviations if deviation != Deviation.OTHER_DIRECTION)
            best.setdefault(
                sweep.direction, (replace(decision, deviations=deviations, parent=self._progress.last), action)
            )
        return list(best.values())

    def _sweep(self, decision: Decision, action: Action) -> bool:
        """Try a sweep; whether it moved anything."""
        before = self._progress.state
        after = self._task.apply(before, action).state
        if (after.displacement(before) <= UNCHANGED).all():
            return False
        self._progress.add(decision, action, after)
        return True

    def _grasp(self, problem: PushProblem) -> Plan | Infeasible:
        """Reach, grasp and withdraw; or why that is not possible."""
        scene, progress = self._task.scene, self._progress
        grasp = self._pushing.grasp(problem)
        if isinstance(grasp, Infeasible):
            return grasp
        made = self._task.apply(progress.state, grasp.action)
        decision = Decision(corridor=problem.corridor, deviations=grasp.deviations, parent=progress.last)
        progress.add(decision, grasp.action, made.state)
        path, half_width = grasp.action.path, self._pushing.half_width
        done = made.motion.complete
        return progress.plan(*grasp_outcome(scene, made.state, path, made.motion, at_pose=done, half_width=half_width))
