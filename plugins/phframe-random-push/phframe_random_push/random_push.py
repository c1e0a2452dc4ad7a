"""Random push: the floor that every other planner must beat."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from phframe.core import Action, Decision, Infeasible, Plan, Planner, State, Status, Task, Transition
from phframe.pushing.clear import UNCHANGED
from phframe.pushing.options import PushingOptions
from phframe.pushing.push import push_action
from phframe.pushing.reach import grasp_action
from phframe.pushing.situation import Pushing, Situation
from phframe.pushing.sweep import Choice, SweepGeometry

Proposal = tuple[Decision, Action]


@dataclass(slots=True)
class Progress:
    """What has been done so far."""

    state: State
    steps: list[tuple[Decision, Action, State]] = field(default_factory=list)

    def add(self, proposal: Proposal, transition: Transition) -> None:
        """Go on from what an action made of the world."""
        self.steps.append((*proposal, transition.state))
        self.state = transition.state

    def plan(self, status: Status, reason: str = "") -> Plan:
        """The actions so far, with the outcome."""
        decisions, actions, expected = zip(*self.steps, strict=True) if self.steps else ((), (), ())
        return Plan(status, reason, actions, expected, decisions)


class RandomPush(Planner[PushingOptions]):
    """Sweeps a random obstacle of the corridor, alone, in a random direction, until the target is free.

    A sweep that moves nothing is left out of the plan, but counts towards ``max_actions``.
    """

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Sweep at random until the gripper can grasp the target."""
        pushing, progress = Pushing(task, self.options), Progress(task.start)
        blockers: tuple[str, ...] = ()
        for _ in range(self.options.max_actions):
            situation = pushing.situation(progress.state, blockers)
            if isinstance(situation, Infeasible):
                return progress.plan(Status.FAILED, situation.reason)
            if len(situation.members) == 0:
                grasp = grasp_action(task.scene, progress.state, situation.corridor, task.arm, self.options)
                if isinstance(grasp, Action):
                    return _grasped(task, progress, situation, grasp)
                if not grasp.blockers:
                    return progress.plan(Status.FAILED, grasp.reason)
                blockers = grasp.blockers
            elif (proposal := self._propose(task, situation)) is None:
                return progress.plan(Status.FAILED, "no sweep fits beside any obstacle")
            elif _moved(transition := task.apply(progress.state, proposal[1]), progress.state):
                progress.add(proposal, transition)
                blockers = ()
        return progress.plan(Status.FAILED, f"the target is not free after {self.options.max_actions} attempts")

    def _propose(self, task: Task, situation: Situation) -> Proposal | None:
        """A random direction of the first obstacle, in random order, beside which a sweep fits."""
        for member in task.rng.permutation(len(situation.members)):
            proposals = self._sweeps(task, situation, int(member))
            if proposals:
                return proposals[task.rng.integers(len(proposals))]
        return None

    def _sweeps(self, task: Task, situation: Situation, member: int) -> list[Proposal]:
        """The sweeps of one obstacle that fit and were not rejected."""
        scene, corridor, row = task.scene, situation.corridor, situation.members[member]
        centre, radius = situation.local[[member]], float(scene.radii[row])
        target_radius = float(scene.radii[scene.target_index])
        geometry = SweepGeometry(corridor, centre, radius, target_radius, scene.shelf, task.arm)
        members = tuple(scene.ids[i] for i in situation.members)
        proposals = []
        for push in geometry.pushes():
            action = push_action(corridor, push.sweep, (scene.ids[row],), self.options)
            choices = tuple(
                choice for choice in push.choices if choice is not Choice.OTHER_DIRECTION
            )  # chance chose it
            decision = Decision(
                corridor=corridor,
                members=members,
                chosen=action.moves,
                rectangle=geometry.rectangle,
                sweep=push.sweep,
                choices=choices,
            )
            if action not in task.rejected:
                proposals.append((decision, action))
        return proposals


def _moved(transition: Transition, before: State) -> bool:
    return bool(np.any(transition.state.displacement(before) > UNCHANGED))


def _grasped(task: Task, progress: Progress, situation: Situation, grasp: Action) -> Plan:
    transition = task.apply(progress.state, grasp)
    progress.add((Decision(corridor=situation.corridor), grasp), transition)
    if transition.state.held == task.scene.target:
        return progress.plan(Status.RETRIEVED)
    if transition.motion.complete:
        return progress.plan(Status.REACHED, "the fingers closed without holding the target")
    return progress.plan(Status.CLEARED, "the reach stalled")
