"""The paper's geometry for one task: the obstacles that count, the pushes that their grouping offers, the grasp."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from phframe.core import (
    Action,
    Condition,
    FloatArray,
    Infeasible,
    IntArray,
    PersistenceDiagram,
    State,
    Task,
    rotated_in_plane,
    rotation_matrix,
    yaw_of,
)
from phframe.geometry.arm_view import arm_view
from phframe.pushing.corridor import Corridor, corridor_half_width, find_corridor, with_room
from phframe.pushing.deviation import Deviation
from phframe.pushing.grasp import Grasp, GraspFinder, Rejects
from phframe.pushing.grouping import closest_component, merged_labels
from phframe.pushing.options import PushingOptions
from phframe.pushing.persistence import persistent_radii, usable_radii, usable_threshold
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.retrieve import Retrieve
from phframe.pushing.sweep import push_action
from phframe.pushing.sweep_generator import SweepGenerator


class Pushing:
    """The paper's geometry for one task, with one planner's options. Holds nothing that changes.

    Args:
        task: The task.
        options: The planner's.

    Attributes:
        scene: The task's, its target the object that is to be retrieved.
        half_width: Of the corridor, w (m).
        threshold: Distance between centres below which nothing can be inserted between two objects, h (m).
    """

    def __init__(self, task: Task, options: PushingOptions) -> None:
        self.task, self.options = task, options
        self.scene = task.goal.scene(task.scene) if isinstance(task.goal, Retrieve) else task.scene
        self.half_width = corridor_half_width(options.half_width, self.scene, task.arm)
        self._radii, self._met = self.scene.radii, task.arm.met(self.scene)
        self._view = arm_view(self.scene.shelf, task.arm, task.arm.min_opening, options.wall_clearance)
        self._grasps = GraspFinder(self.scene, task.arm, options)
        obstacles = np.delete(self._radii, self.scene.target_index)
        self.threshold = usable_threshold(options.insertion_width, float(obstacles.max(initial=0.0)))

    def problem(self, state: State, blockers: Sequence[str] = ()) -> PushProblem | Infeasible:
        """What is to be pushed aside so that the target can be reached.

        Args:
            state: The world at rest.
            blockers: Ids of obstacles that count although they are not in the corridor.
        """
        scene, row = self.scene, self.scene.target_index
        if not isinstance(self.task.goal, Retrieve):
            return Infeasible(f"pushing aside serves to retrieve a target; the goal is {type(self.task.goal).__name__}")
        if state.conditions[row] is not Condition.UPRIGHT:
            return Infeasible(f"the target {scene.target!r} is {state.conditions[row]}")
        corridor = find_corridor(state.positions[row], scene.shelf, self.half_width)
        if isinstance(corridor, Infeasible):
            return corridor
        chosen = self._with_room(corridor, state) if self.options.sweeps == "fitted" else corridor
        deviations = () if chosen is corridor else (Deviation.ANGLED_EARLY,)
        return replace(self.problem_along(state, chosen, blockers), deviations=deviations)

    def problem_along(self, state: State, corridor: Corridor, blockers: Sequence[str] = ()) -> PushProblem:
        """What is to be pushed out of any corridor to the target; see ``corridor_at``."""
        members = self._members(corridor, state, blockers)
        return PushProblem(state, corridor, members, corridor.to_local(state.positions[members]), tuple(blockers))

    def _with_room(self, corridor: Corridor, state: State) -> Corridor:
        inside = self._members(corridor, state)
        return with_room(corridor, self.scene.shelf, state.positions[inside], self._radii[inside])

    def _members(self, corridor: Corridor, state: State, blockers: Sequence[str] = ()) -> IntArray:
        counts = corridor.contains(state.positions)
        if blockers:
            counts |= np.isin(self.scene.ids, list(blockers))
        counts[self.scene.target_index] = False
        return np.flatnonzero(counts & state.on_board & self._met)

    def diagram(self, problem: PushProblem) -> PersistenceDiagram:
        """The persistence diagram of the obstacles that count, by their landmarks: of cylinders, the centres."""
        return self.task.diagram(self._landmarks(problem)[0])

    def components(self, problem: PushProblem, radius: float) -> IntArray:
        """The component of each member ``(k,)`` at a radius (m); what an object has landmarks in is one."""
        points, owners = self._landmarks(problem)
        return merged_labels(self.task.components(points, radius), owners)

    def _landmarks(self, problem: PushProblem) -> tuple[FloatArray, IntArray]:
        """Landmarks ``(m, 2)`` of the members in the corridor frame (m), and the member that each belongs to ``(m,)``."""
        shapes = [self.scene.objects[row].shape for row in problem.members]
        own = [shape.landmarks for shape in shapes]
        if not any(points.any() for points in own):
            return problem.local, np.arange(len(own))
        yaws = [yaw_of(pose) - problem.corridor.angle for pose in problem.state.poses[problem.members]]
        turned = [rotated_in_plane(points, rotation_matrix(yaw).T) for points, yaw in zip(own, yaws, strict=True)]
        placed = [points + center for points, center in zip(turned, problem.local, strict=True)]
        return np.vstack(placed), np.repeat(np.arange(len(own)), [len(points) for points in own])

    def radii(self, diagram: PersistenceDiagram) -> list[float]:
        """The usable radii, ascending (m): persistent by the margin nu and above the threshold h."""
        found: list[float] = usable_radii(diagram.finite_deaths, self.options.margin, self.threshold).tolist()
        return found

    def pushes(
        self, problem: PushProblem, diagram: PersistenceDiagram, radius: float, deviations: tuple[str, ...] = ()
    ) -> Iterator[tuple[PushDecision, Action]]:
        """The pushes of the closest component at a radius, best first, without those that were rejected.

        Args:
            problem: With at least one member.
            diagram: Of its members.
            radius: At which to group (m).
            deviations: Those that led to the radius.
        """
        labels = self.components(problem, radius)
        chosen = closest_component(problem.local, labels, problem.corridor.axis)
        persistent = tuple(persistent_radii(diagram.finite_deaths, self.options.margin).tolist())
        blocked = (Deviation.GRASP_BLOCKED,) if problem.blockers else ()
        for decision, action in self.sweeps(problem, chosen):
            grouped = replace(
                decision,
                why=f"the closest component at a radius of {1000 * radius:.0f} mm",
                deviations=(*deviations, *blocked, *decision.deviations),
                diagram=diagram,
                persistent_radii=persistent,
                radius=radius,
                labels=labels,
            )
            yield grouped, action

    def pushes_at_all_radii(self, problem: PushProblem) -> Iterator[Iterator[tuple[PushDecision, Action]]]:
        """``pushes`` at every usable radius, ascending; where there is none, at the threshold h."""
        diagram = self.diagram(problem)
        radii = self.radii(diagram)
        deviations = () if radii else (Deviation.FALLBACK_RADIUS,)
        for radius in radii or [self.threshold]:
            yield self.pushes(problem, diagram, radius, deviations)

    def sweeps(self, problem: PushProblem, chosen: IntArray) -> Iterator[tuple[PushDecision, Action]]:
        """The sweeps of any group of members, best first, without those that were rejected.

        Args:
            problem: With at least one member.
            chosen: Indices ``(k,)`` of the group among the members.
        """
        ids, corridor = self.scene.ids, problem.corridor
        names = tuple(ids[row] for row in problem.members[chosen])
        members = tuple(ids[row] for row in problem.members)
        generator = self._generator(problem, chosen)
        for push in generator.pushes():
            action = push_action(corridor, push.sweep, names, self.task.arm.min_opening, self.options)
            if self.task.rejects(action) is None:
                yield (
                    PushDecision(
                        "a group of obstacles",
                        (*problem.deviations, *push.deviations),
                        corridor=corridor,
                        members=members,
                        chosen=names,
                        rectangle=generator.rectangle,
                        sweep=push.sweep,
                    ),
                    action,
                )

    def grasp(self, problem: PushProblem) -> Grasp | Infeasible:
        """The reach, grasp and withdrawal along the corridor, if the target can be got at without what was rejected."""
        (found,) = self.grasps_along(problem.state, [problem.corridor])
        if isinstance(found, Infeasible):
            return found
        return replace(found, deviations=(*problem.deviations, *found.deviations))

    def grasps_along(
        self, state: State, corridors: Sequence[Corridor], rejects: Rejects = lambda _: None
    ) -> list[Grasp | Infeasible]:
        """The same along each of any corridors (see ``corridor_at``), without what is rejected besides."""
        return self._grasps.candidates(state, corridors, lambda action: self.task.rejects(action) or rejects(action))

    def _generator(self, problem: PushProblem, chosen: IntArray) -> SweepGenerator:
        return SweepGenerator(
            problem.corridor,
            problem.local[chosen],
            float(self._radii[problem.members[chosen]].max()),
            float(self._radii[self.scene.target_index]),
            self._view,
            self.options,
        )
