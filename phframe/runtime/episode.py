"""A plan carried out, closed loop: plan, execute every action in order, observe, replan where reality differs."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from phframe.core import (
    Action,
    ActionKind,
    Assessment,
    Attempt,
    Budget,
    Condition,
    Cost,
    Decision,
    Episode,
    ExploredTree,
    Goal,
    Plan,
    Planner,
    Rejection,
    RunSpec,
    SimulationDivergedError,
    State,
    Status,
    Step,
    TopologyEngine,
    Unreachable,
    Watch,
)
from phframe.core.episode import MOVED
from phframe.core.errors import BudgetExceededError, error_text
from phframe.runtime.aids import Aids
from phframe.runtime.blame import blamed
from phframe.runtime.border import ask_planner
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.observer import MountedArm, Observer
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.sensor import Sensor
from phframe.runtime.versions import versions_of

FRAME_PERIOD = 1.0 / 30.0
"""Of the world's time, between the moments that observers are shown (s)."""
LEAST_TO_ACT = 60.0
"""Wall time that carrying out may take at least, all actions together (s); at most it is as long as planning may."""
MOST_ALIKE = 5
"""Of grasps, one after another, that came to the same and changed nothing: a sixth, from yet another side, would, too."""
UNFINISHED = "unfinished: this is what there was of it when it was written down last"
"""Why an episode got no farther, in a file that was written while it ran."""


def run_episode(
    planner: Planner[Any],
    topology: TopologyEngine[Any],
    planning: PlanningWorld,
    execution: ExecutionWorld,
    goal: Goal[Any],
    spec: RunSpec,
    observers: Sequence[Observer] = (),
    sensor: Sensor | None = None,
    aids: Aids = Aids(),  # noqa: B008 - immutable
) -> Episode:
    """Plan in one world and carry the plan out in another, which may be more real.

    A failed plan's actions are not executed. Observers are told as it happens; they are not closed here.

    Args:
        planner: Makes the plans.
        topology: For the planner.
        planning: Where it plans.
        execution: Where the plan is carried out, from the scene's initial state on.
        goal: What is to be achieved, and the judge of it.
        spec: What to note in the episode; its seed and loop are followed.
        observers: Who looks on.
        sensor: Through which the robot sees the world: what it plans, expects and aims at comes from that, what is told
            of the episode from the world as it is. None: it sees everything as it is.
        aids: What the planner may use besides.
    """
    see = (lambda state: state) if sensor is None else sensor.see
    return _Run(planner, topology, planning, execution, goal, spec, observers, see, aids).episode()


class _Run:
    """One episode under way."""

    def __init__(
        self,
        planner: Planner[Any],
        topology: TopologyEngine[Any],
        planning: PlanningWorld,
        execution: ExecutionWorld,
        goal: Goal[Any],
        spec: RunSpec,
        observers: Sequence[Observer],
        see: Callable[[State], State],
        aids: Aids,
    ) -> None:
        self._planner, self._topology, self._planning, self._execution = planner, topology, planning, execution
        self._goal, self._spec, self._loop, self._observers, self._see = goal, spec, spec.loop, observers, see
        self._aids, self._scene = aids, execution.scene
        self._seeds = np.random.SeedSequence(spec.seed)
        self._plans: list[Plan] = []
        self._steps: list[Step] = []
        self._rejections: tuple[Rejection, ...] = ()
        self._rejected_in: list[State] = []
        self._state = self._seen = self._scene.initial_state()
        self._versions = versions_of(spec)
        self._acted = 0.0

    def episode(self) -> Episode:
        arm = MountedArm(self._execution.arm, self._execution.base_pose, self._execution.by_joints)
        self._tell(lambda observer: observer.begin(self._scene, self._spec, arm))
        try:
            self._progress()
            self._note(self._execution.start())
            episode = self._so_far(*self._outcome())
        except BaseException as error:
            blame = error_text(blamed(error, self._spec))
            reason = "interrupted by Ctrl-C" if isinstance(error, KeyboardInterrupt) else blame
            partial = self._so_far(Status.FAILED, reason)
            self._tell(lambda observer: observer.interrupted(partial))
            raise
        self._tell(lambda observer: observer.finished(episode))
        return episode

    def _progress(self) -> None:
        """Show what there is so far."""
        partial = self._so_far(Status.FAILED, UNFINISHED)
        self._tell(lambda observer: observer.progressed(partial))

    def _so_far(self, status: Status, reason: str) -> Episode:
        return Episode(
            self._scene,
            self._spec,
            status,
            reason,
            tuple(self._plans),
            tuple(self._steps),
            self._rejections,
            self._execution.motion_planning_time + self._motion_planning_within,
            self._versions,
        )

    def _note(self, state: State) -> None:
        """Note what the world is now, and what the robot sees of it."""
        self._state, self._seen = state, self._see(state)

    def _outcome(self) -> tuple[Status, str]:
        """How it went; a simulation that diverges is an outcome, too, and so is a limit."""
        try:
            return self._loop_until_done()
        except SimulationDivergedError as error:
            return Status.FAILED, str(error)
        except BudgetExceededError as error:
            return Status.TIMEOUT, str(error)

    def _loop_until_done(self) -> tuple[Status, str]:
        """Plan and carry out until the goal is met or there is no reason to try again."""
        while True:
            plan = self._plan()
            if not plan.succeeded:
                return plan.status, plan.reason
            problem = self._carry_out(plan)
            outcome = self._assess()
            if outcome.status.is_success:
                return outcome.status, ""
            if outcome.lost or not problem or len(self._plans) > self._loop.max_replans:
                return self._ended(outcome, problem)
            if self._is_stuck:
                return outcome.status, f"{MOST_ALIKE} grasps in a row came to the same and changed nothing: {problem}"

    def _ended(self, outcome: Assessment, problem: str) -> tuple[Status, str]:
        """How far it got, and why no farther: what went wrong last, and what the goal's judge says."""
        reasons = [problem, outcome.reason] if outcome.lost else [problem or outcome.reason]
        return outcome.status, "; ".join(dict.fromkeys(filter(None, reasons)))

    def _assess(self) -> Assessment:
        """What the goal makes of the world as it is."""
        self._tell(lambda observer: observer.acting(LEAST_TO_ACT))
        last = self._steps[-1] if self._steps else None
        attempt = None if last is None else Attempt(last.action, last.motion, last.trajectory)
        return self._goal.assess(self._scene, self._state, attempt)

    def _plan(self) -> Plan:
        """Ask the planner, with what is left of the time."""
        spent, loop = sum((plan.cost for plan in self._plans), Cost()), self._loop
        simulations = None if loop.simulations is None else max(0, loop.simulations - spent.simulated_actions)
        before = self._motion_planning_within
        confirmation, particles = self._aids.confirmation, self._aids.particles
        start = self._seen if self._same_arm else self._seen.for_another_arm()
        task = self._planning.task(
            start,
            self._topology,
            np.random.default_rng(self._seeds.spawn(1)[0]),
            goal=self._goal,
            arm=self._execution.arm.shape,
            budget=Budget(max(0.0, loop.time_limit - spent.total), simulations),
            rejected=self._rejections,
            earlier=self._earlier,
            reach=self._execution.unreachable,
            confirm=None if confirmation is None else confirmation.apply,
            sample=None if particles is None else lambda number: particles.draw(start, number),
            object_reach=self._execution.out_of_reach,
            advisor=self._aids.advisor,
        )
        self._tell(lambda observer: observer.planning(task.budget.seconds))
        plan = ask_planner(self._planner, task)
        within = self._motion_planning_within - before
        plan = replace(plan, cost=replace(plan.cost, motion_planning=plan.cost.motion_planning + within))
        self._plans.append(plan)
        self._tell(lambda observer: observer.planned(plan))
        self._progress()
        return plan

    @property
    def _motion_planning_within(self) -> float:
        """Wall time of motion planning for simulated actions so far (s)."""
        return self._planning.motion_planning_time + self._aids.motion_planning_time

    @property
    def _earlier(self) -> ExploredTree | None:
        """What the last plan had tried from where its actions that were carried out were to lead."""
        if not self._plans or (tree := self._plans[-1].tree) is None:
            return None
        return tree.after(sum(step.plan == len(self._plans) - 1 for step in self._steps))

    @property
    def _same_arm(self) -> bool:
        ours, theirs = self._planning.spec, self._execution.spec
        return (ours.backend, ours.arm) == (theirs.backend, theirs.arm)

    def _carry_out(self, plan: Plan) -> str:
        """Carry out every action of a plan, in order; why to plan again, if something was not as expected."""
        assert plan.tree is not None or not plan.actions, "a plan's actions are a path of its tree"
        before = plan.tree.nodes[0].state if plan.tree is not None else self._seen
        for number, (action, expected, decision) in enumerate(
            zip(plan.actions, plan.expected, plan.decisions, strict=True), start=1
        ):
            aimed = self._aimed(action, before)
            last = number == len(plan.actions)
            problem = self._came_to_nothing(aimed) or self._step(aimed, expected, decision)
            if problem := problem or self._shortfall(aimed, expected, last=last):
                return problem
            before = expected
        return ""

    def _aimed(self, action: Action, planned: State) -> Action:
        """A planned grasp, moved along with its object to where that is now."""
        if action.kind is not ActionKind.GRASP or action.path.manipuland is None:
            return action
        row = self._scene.index(action.path.manipuland)
        shift = np.append(self._seen.positions[row] - planned.positions[row], 0.0)
        return replace(action, path=action.path.shifted(shift))

    def _shortfall(self, action: Action, expected: State, *, last: bool) -> str:
        """Why an action that was carried out did not do what it should, if so; the goal judges the plan's last one."""
        if last and action.kind is ActionKind.GRASP:
            outcome = self._assess()
            if not outcome.status.is_success:
                self._reject(action, outcome.reason)
            return outcome.reason
        problem = self._deviation(expected, action)
        if problem and action.moves and self._is_idle:
            self._reject(action, "nothing moved")
        return problem

    @property
    def _is_idle(self) -> bool:
        """Whether the last action moved nothing."""
        step = self._steps[-1]
        return bool((step.after.displacement(step.before) <= MOVED).all())

    def _reject(self, action: Action, reason: str, unreachable: Unreachable | None = None) -> None:
        self._rejections = (*self._rejections, Rejection(action, reason, unreachable, len(self._plans) - 1))
        self._rejected_in.append(self._state)

    def _came_to_nothing(self, action: Action) -> str:
        """Why an action is not done once more: it came to nothing before, and nothing has moved since."""
        for rejection, then in zip(self._rejections, self._rejected_in, strict=True):
            if rejection.action.resembles(action) and (self._state.displacement(then) <= MOVED).all():
                return f"{rejection.reason}; the planner proposes the same again: {action.name}"
        return ""

    @property
    def _is_stuck(self) -> bool:
        """Whether the last grasps that were carried out all came to the same, from states that are about the same."""
        last, states = self._rejections[-MOST_ALIKE:], self._rejected_in[-MOST_ALIKE:]
        return (
            len(last) == MOST_ALIKE
            and all(each.action.kind is ActionKind.GRASP and each.unreachable is None for each in last)
            and len({each.reason for each in last}) == 1
            and all((self._state.displacement(then) <= self._loop.tolerance).all() for then in states)
        )

    def _step(self, action: Action, expected: State, decision: Decision) -> str:
        """Carry out one action; why not, where the arm cannot."""
        before = self._state
        frames: list[tuple[float, State]] = []
        with self._timed():
            trajectory = self._execution.plan_trajectory(self._seen, action)
            if not isinstance(trajectory, Unreachable):
                watch = Watch(FRAME_PERIOD, lambda at, state: frames.append((at, state))) if self._observers else None
                motion = self._execution.execute(trajectory, watch)
                self._note(self._execution.observe())
        if isinstance(trajectory, Unreachable):
            problem = f"the arm cannot do {action.name}: {trajectory.why}"
            self._reject(action, problem, trajectory)
            return problem
        seen = None if self._seen is self._state else self._seen
        plan = len(self._plans) - 1
        step = Step(action, trajectory, before, self._state, expected, motion, decision, plan, seen)
        self._steps.append(step)
        self._tell(lambda observer: observer.stepped(step, frames))
        self._progress()
        return ""

    @contextmanager
    def _timed(self) -> Iterator[None]:
        """Count what carrying out takes, and begin nothing once it has taken too long.

        Raises:
            BudgetExceededError: If it has.
        """
        limit = max(LEAST_TO_ACT, self._loop.time_limit)
        left = limit - self._acted
        if left <= 0.0:
            raise BudgetExceededError(f"carrying out took longer than {limit:g} s")
        self._tell(lambda observer: observer.acting(left))
        began = time.perf_counter()
        try:
            yield
        finally:
            self._acted += time.perf_counter() - began

    def _deviation(self, expected: State, action: Action) -> str:
        """What is not where it was expected, if anything; of what lay before, engines in the plane know no better."""
        if self._seen.held != expected.held:
            return (
                f"{self._seen.held or 'nothing'} is in the hand after {action.name}, not {expected.held or 'nothing'}"
            )
        deviation = self._seen.displacement(expected)
        deviation[[was is not Condition.UPRIGHT for was in self._steps[-1].before.conditions]] = 0.0
        worst = int(deviation.argmax())
        if deviation[worst] <= self._loop.tolerance:
            return ""
        what = f"{deviation[worst]:.3f} m from where" if np.isfinite(deviation[worst]) else "not in the condition"
        return f"{self._scene.ids[worst]} is {what} it was expected after {action.name}"

    def _tell(self, what: Callable[[Observer], None]) -> None:
        for observer in self._observers:
            what(observer)
