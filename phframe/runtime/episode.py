"""A plan carried out, closed loop: plan, execute, observe, replan where reality differs; then reach, grasp, withdraw."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from phframe.core import (
    Action,
    Budget,
    Condition,
    Cost,
    Decision,
    Episode,
    Infeasible,
    JointTrajectory,
    Loop,
    Phase,
    Plan,
    Planner,
    Setup,
    SimulationDivergedError,
    State,
    Status,
    Step,
    TopologyEngine,
    Unreachable,
    Watch,
)
from phframe.core.episode import MOVED
from phframe.pushing.corridor import corridor_half_width, find_corridor
from phframe.pushing.options import PushingOptions
from phframe.pushing.outcome import grasp_outcome, is_cleared
from phframe.pushing.reach import Grasp, grasp_action
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.observer import MountedArm, Observer
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.sensor import Sensor

FRAME_PERIOD = 1.0 / 30.0
"""Of the world's time, between the moments that observers are shown (s)."""

MOST_REJECTED = 20
"""Actions that the arm could not do, or that came to nothing, for which others are sought without counting that as a replan."""


def run_episode(
    planner: Planner[Any],
    topology: TopologyEngine[Any],
    planning: PlanningWorld,
    execution: ExecutionWorld,
    setup: Setup,
    loop: Loop = Loop(),  # noqa: B008 - immutable
    observers: Sequence[Observer] = (),
    sensor: Sensor | None = None,
) -> Episode:
    """Plan in one world and carry the plan out in another, which may be more real.

    A failed plan's actions are not executed. Observers are told as it happens; they are not closed here.

    Args:
        planner: Makes the plans.
        topology: For the planner.
        planning: Where it plans.
        execution: Where the plan is carried out, from the scene's initial state on.
        setup: What to note in the episode.
        loop: When to replan, and how often.
        observers: Who looks on.
        sensor: Through which the robot sees the world: what it plans, expects and aims at comes from that, what is told
            of the episode from the world as it is. None: it sees everything as it is.
    """
    see = (lambda state: state) if sensor is None else sensor.see
    return _Run(planner, topology, planning, execution, setup, loop, observers, see).episode()


class _Run:
    """One episode under way."""

    def __init__(
        self,
        planner: Planner[Any],
        topology: TopologyEngine[Any],
        planning: PlanningWorld,
        execution: ExecutionWorld,
        setup: Setup,
        loop: Loop,
        observers: Sequence[Observer],
        see: Callable[[State], State],
    ) -> None:
        self._planner, self._topology, self._planning, self._execution = planner, topology, planning, execution
        self._setup, self._loop, self._observers, self._see = setup, loop, observers, see
        self._scene = execution.scene
        self._seeds = np.random.SeedSequence(setup.seed)
        self._plans: list[Plan] = []
        self._steps: list[Step] = []
        self._rejected: tuple[Action, ...] = ()
        self._state = self._seen = self._planned_from = self._scene.initial_state()

    def episode(self) -> Episode:
        arm = MountedArm(self._execution.arm, self._execution.base_pose, self._execution.by_joints)
        self._tell(lambda observer: observer.begin(self._scene, self._setup, arm))
        self._note(self._execution.start())
        status, reason = self._outcome()
        spent = self._execution.motion_planning_time + self._planning.motion_planning_time
        plans, steps = tuple(self._plans), tuple(self._steps)
        episode = Episode(self._scene, self._setup, status, reason, plans, steps, spent)
        self._tell(lambda observer: observer.finished(episode))
        return episode

    def _note(self, state: State) -> None:
        """Note what the world is now, and what the robot sees of it."""
        self._state, self._seen = state, self._see(state)

    def _outcome(self) -> tuple[Status, str]:
        """How it went; a simulation that diverges is an outcome, too."""
        try:
            return self._loop_until_done()
        except SimulationDivergedError as error:
            return Status.FAILED, str(error)

    def _loop_until_done(self) -> tuple[Status, str]:
        """Plan and carry out until a plan came true or there is no reason to try again."""
        while True:
            plan = self._plan()
            if not plan.succeeded:
                return plan.status, plan.reason
            problem = self._push(plan)
            status, reason = (Status.FAILED, problem) if problem else self._grasp(plan)
            if status is Status.RETRIEVED:
                return status, ""
            if self._lost:
                return Status.FAILED, f"the target was lost: {reason}"
            if self._state.held is not None:
                return Status.FAILED, f"{self._state.held} is in the hand instead of {self._scene.target}"
            if self._exhausted:
                return status, reason

    @property
    def _exhausted(self) -> bool:
        """Whether there were enough replans; one that only stands in for what the arm could not do is excused."""
        return len(self._plans) - min(len(self._rejected), MOST_REJECTED) > self._loop.max_replans

    def _plan(self) -> Plan:
        """Ask the planner, with what is left of the time."""
        spent, loop = sum((plan.cost for plan in self._plans), Cost()), self._loop
        simulations = None if loop.simulations is None else max(0, loop.simulations - spent.simulated_actions)
        task = self._planning.task(
            self._seen if self._same_arm else replace(self._seen, held=None, arm=None),
            self._topology,
            np.random.default_rng(self._seeds.spawn(1)[0]),
            arm=self._execution.arm.shape,
            budget=Budget(max(0.0, loop.time_limit - spent.total), simulations),
            rejected=self._rejected,
        )
        self._planned_from = task.start
        plan = self._planner.plan(task)
        self._plans.append(plan)
        self._tell(lambda observer: observer.planned(plan))
        return plan

    @property
    def _same_arm(self) -> bool:
        ours, theirs = self._planning.spec, self._execution.spec
        return (ours.backend, ours.arm) == (theirs.backend, theirs.arm)

    def _push(self, plan: Plan) -> str:
        """Carry out the plan's pushes; why to replan, if something was not as expected."""
        for action, expected, decision in zip(plan.actions, plan.expected, plan.decisions, strict=True):
            if action.grasps:
                break
            if problem := self._step(action, expected, decision):
                return problem
            if problem := self._deviation(expected, action):
                self._reject_if_idle(action)
                return problem
        return ""

    def _reject_if_idle(self, action: Action) -> None:
        """Have no action again that was to move something and moved nothing: it would go on moving nothing."""
        step = self._steps[-1]
        if (step.after.displacement(step.before) <= MOVED).all():
            self._rejected = (*self._rejected, action)

    def _grasp(self, plan: Plan) -> tuple[Status, str]:
        """Reach, grasp and withdraw: as planned, or where the plan ends with an empty corridor, as the paper allows."""
        if plan.actions and plan.actions[-1].grasps:
            before = plan.expected[-2] if len(plan.expected) > 1 else self._planned_from
            action, expected, decision = self._aimed(plan.actions[-1], before), plan.expected[-1], plan.decisions[-1]
        else:
            found = self._find_grasp(plan)
            if isinstance(found, Infeasible):
                return self._as_it_stands(self._half_width(plan)), found.reason
            action, expected, decision = found.action, None, Decision(deviations=found.deviations)
        half_width = self._half_width(plan)
        if rejection := self._step(action, expected, decision):
            return self._as_it_stands(half_width), rejection
        status, reason = self._grasp_outcome(half_width)
        if status is not Status.RETRIEVED:
            self._rejected = (*self._rejected, action)
        return status, reason

    def _aimed(self, action: Action, planned: State) -> Action:
        """A planned grasp, moved along with the target to where it is now."""
        row = self._scene.target_index
        shift = np.append(self._seen.positions[row] - planned.positions[row], 0.0)
        return replace(action, path=replace(action.path, poses=action.path.poses + shift))

    def _find_grasp(self, plan: Plan) -> Grasp | Infeasible:
        arm, target = self._execution.arm.shape, self._seen.positions[self._scene.target_index]
        corridor = find_corridor(target, self._scene.shelf, self._half_width(plan))
        if isinstance(corridor, Infeasible):
            return corridor
        return grasp_action(self._scene, self._seen, corridor, arm, self._pushing_options, self._rejected)

    @property
    def _pushing_options(self) -> PushingOptions:
        options = self._planner.options
        return options if isinstance(options, PushingOptions) else PushingOptions()

    def _half_width(self, plan: Plan) -> float:
        """Of the corridor that the planner meant, or of the default one."""
        corridors = [decision.corridor for decision in plan.decisions if decision.corridor is not None]
        arm = self._execution.arm.shape
        return (
            corridors[-1].half_width
            if corridors
            else corridor_half_width(self._pushing_options.half_width, self._scene, arm)
        )

    def _as_it_stands(self, half_width: float) -> Status:
        """How far it got without a grasp."""
        return Status.CLEARED if is_cleared(self._scene, self._state, half_width) else Status.FAILED

    def _grasp_outcome(self, half_width: float) -> tuple[Status, str]:
        step = self._steps[-1]
        at_pose = step.motion.complete or step.motion.followed >= _end_of_reach(step)
        path = step.action.path
        return grasp_outcome(self._scene, self._state, path, step.motion, at_pose=at_pose, half_width=half_width)

    def _step(self, action: Action, expected: State | None, decision: Decision) -> str:
        """Carry out one action; why not, where the arm cannot."""
        before = self._state
        trajectory = self._execution.plan_trajectory(self._seen, action)
        if isinstance(trajectory, Unreachable):
            self._rejected = (*self._rejected, action)
            return f"the arm cannot do {action.name}: {trajectory.why}"
        frames: list[tuple[float, State]] = []
        watch = Watch(FRAME_PERIOD, lambda time, state: frames.append((time, state))) if self._observers else None
        motion = self._execution.execute(trajectory, watch)
        self._note(self._execution.observe())
        step = Step(action, trajectory, before, self._state, expected, motion, decision, len(self._plans) - 1)
        self._steps.append(step)
        self._tell(lambda observer: observer.stepped(step, frames))
        return ""

    def _deviation(self, expected: State, action: Action) -> str:
        """What is not where it was expected, if anything; of what lay before, engines in the plane know no better."""
        deviation = self._seen.displacement(expected)
        deviation[[was is not Condition.UPRIGHT for was in self._steps[-1].before.conditions]] = 0.0
        worst = int(deviation.argmax())
        if deviation[worst] <= self._loop.tolerance:
            return ""
        what = f"{deviation[worst]:.3f} m from where" if np.isfinite(deviation[worst]) else "not in the condition"
        return f"{self._scene.ids[worst]} is {what} it was expected after {action.name}"

    @property
    def _lost(self) -> bool:
        """Whether the target can no longer be retrieved."""
        return self._state.conditions[self._scene.target_index] is not Condition.UPRIGHT

    def _tell(self, what: Callable[[Observer], None]) -> None:
        for observer in self._observers:
            what(observer)


def _end_of_reach(step: Step) -> float:
    """When the gripper is at the grasp pose (s)."""
    trajectory = step.trajectory.gripper if isinstance(step.trajectory, JointTrajectory) else step.trajectory
    first_grasp = trajectory.phases.index(Phase.GRASP)
    return float(trajectory.times[first_grasp])
