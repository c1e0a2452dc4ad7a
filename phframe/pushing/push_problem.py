"""A state seen along its corridor: which obstacles count, and the pushes that their grouping at a radius offers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from phframe.core import (
    Action,
    Condition,
    Corridor,
    Decision,
    FloatArray,
    Infeasible,
    IntArray,
    PersistenceDiagram,
    State,
    Task,
)
from phframe.geometry.arm_view import ArmView
from phframe.pushing.corridor import corridor_half_width, find_corridor
from phframe.pushing.grouping import closest_component
from phframe.pushing.options import PushingOptions
from phframe.pushing.persistence import persistent_radii, usable_threshold
from phframe.pushing.push import push_action
from phframe.pushing.reach import Grasp, grasp_action
from phframe.pushing.sweep import SweepGeometry

WALL_CLEARANCE = 0.002
"""Kept between the arm and the walls (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class PushProblem:
    """One state, its corridor and the obstacles that must go.

    Attributes:
        state: The world at rest.
        corridor: To the target, where it is now.
        members: Rows of the obstacles that count, ``(k,)``.
        local: Their centres ``(k, 2)`` in the corridor frame (m).
    """

    state: State
    corridor: Corridor
    members: IntArray
    local: FloatArray


class Pushing:
    """The paper's geometry for one task, with one planner's options. Holds nothing that changes.

    Args:
        task: The task.
        options: The planner's.
    """

    def __init__(self, task: Task, options: PushingOptions) -> None:
        self.task, self.options = task, options
        self.half_width = corridor_half_width(options.half_width, task.scene, task.arm)
        self._radii = task.scene.radii
        self._view = ArmView(task.scene.shelf, task.arm.closed, WALL_CLEARANCE)
        obstacles = np.delete(self._radii, task.scene.target_index)
        self.threshold = usable_threshold(options.insertion_width, float(obstacles.max(initial=0.0)))

    def problem(self, state: State, also: tuple[str, ...] = ()) -> PushProblem | Infeasible:
        """What is in the way to the target.

        Args:
            state: The world at rest.
            also: Ids of obstacles that count although they are not in the corridor.
        """
        scene, row = self.task.scene, self.task.scene.target_index
        if state.conditions[row] is not Condition.UPRIGHT:
            return Infeasible(f"the target {scene.target!r} is {state.conditions[row]}")
        corridor = find_corridor(state.positions[row], scene.shelf, self.half_width)
        if isinstance(corridor, Infeasible):
            return corridor
        counts = corridor.contains(state.positions) | np.isin(scene.ids, also)
        counts[row] = False
        members = np.flatnonzero(counts & state.on_board)
        return PushProblem(state, corridor, members, corridor.to_local(state.positions[members]))

    def diagram(self, problem: PushProblem) -> PersistenceDiagram:
        """The persistence diagram of the obstacles that count."""
        return self.task.diagram(problem.local)

    def pushes(
        self, problem: PushProblem, diagram: PersistenceDiagram, radius: float, deviations: tuple[str, ...] = ()
    ) -> Iterator[tuple[Decision, Action]]:
        """The pushes of the closest component at a radius, best first, without those that were rejected.

        Args:
            problem: With at least one member.
            diagram: Of its members.
            radius: At which to group (m).
            deviations: Deviations that led to the radius.
        """
        labels = self.task.components(problem.local, radius)
        chosen = closest_component(problem.local, labels, problem.corridor.axis)
        persistent = persistent_radii(diagram.finite_deaths, self.options.margin)
        for decision, action in self.sweeps(problem, chosen):
            grouped = replace(
                decision,
                diagram=diagram,
                persistent_radii=tuple(persistent.tolist()),
                radius=radius,
                labels=labels,
                deviations=(*deviations, *decision.deviations),
            )
            yield grouped, action

    def sweeps(self, problem: PushProblem, chosen: IntArray) -> Iterator[tuple[Decision, Action]]:
        """The sweeps of any group of members, best first, without those that were rejected.

        Args:
            problem: With at least one member.
            chosen: Indices ``(k,)`` of the group among the members.
        """
        ids, corridor = self.task.scene.ids, problem.corridor
        names = tuple(ids[row] for row in problem.members[chosen])
        geometry = self._geometry(problem, chosen)
        for push in geometry.pushes():
            action = push_action(corridor, push.sweep, names, self.task.arm.min_opening, self.options)
            if action in self.task.rejected:
                continue
            decision = Decision(
                corridor=corridor,
                members=tuple(ids[row] for row in problem.members),
                chosen=names,
                rectangle=geometry.rectangle,
                sweep=push.sweep,
                deviations=push.deviations,
            )
            yield decision, action

    def grasp(self, problem: PushProblem) -> Grasp | Infeasible:
        """The reach, grasp and withdrawal along the corridor, if the target can be got at without what was rejected."""
        task = self.task
        return grasp_action(task.scene, problem.state, problem.corridor, task.arm, self.options, task.rejected)

    def _geometry(self, problem: PushProblem, chosen: IntArray) -> SweepGeometry:
        scene = self.task.scene
        return SweepGeometry(
            problem.corridor,
            problem.local[chosen],
            float(self._radii[problem.members[chosen]].max()),
            float(self._radii[scene.target_index]),
            self._view,
        )
