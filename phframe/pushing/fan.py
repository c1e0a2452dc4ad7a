"""Straight drives to the target at a fan of angles: grasps that nothing blocks, and what blocks the others."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from phframe.core import Condition, Infeasible, State
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.pushing.corridor import Corridor, corridor_at
from phframe.pushing.grasp import Grasp, Rejects
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.pushing import Pushing
from phframe.pushing.retrieve import Retrieve

WIDE_FAN = tuple(math.radians(degrees) for degrees in (0, 15, -15, 30, -30, 45, -45))
"""Angles in the shelf frame, positive towards the north (rad)."""
SAME_ANGLE = math.radians(2.0)
"""Angles that differ by less are one (rad)."""


@dataclass(frozen=True, slots=True, eq=False)
class Drive:
    """One straight drive to the target.

    Attributes:
        problem: The corridor at its angle, and what blocks it.
        grasp: What can be done as it is, or why not.
    """

    problem: PushProblem
    grasp: Grasp | Infeasible

    @property
    def angle(self) -> float:
        """Of the drive (rad), positive towards the north."""
        return self.problem.corridor.angle

    @property
    def blocking(self) -> int:
        """How many obstacles block it."""
        return len(self.problem.members)

    @property
    def by_wall(self) -> bool:
        """Whether a wall, or the arm itself, is what blocks it: no push of obstacles helps."""
        return isinstance(self.grasp, Infeasible) and not self.grasp.blockers


def drives(
    pushing: Pushing, state: State, fan: Sequence[float], rejects: Rejects = lambda _: None
) -> list[Drive] | Infeasible:
    """The drives to the target where it is now: along the paper's corridor, and at the angles of a fan.

    Args:
        pushing: The geometry of the task.
        state: The world at rest.
        fan: Angles in the shelf frame (rad).
        rejects: Tells why a grasp is not to be proposed; None: it may be.

    Returns:
        None at all where the paper has no corridor and the fan no angle; why, where the target cannot be retrieved by any.
    """
    problem = pushing.problem(state)
    if isinstance(problem, Infeasible) and not _is_retrievable(pushing, state):
        return problem
    corridors = [] if isinstance(problem, Infeasible) else [problem.corridor]
    target = state.positions[pushing.scene.target_index]
    for angle in fan:
        known = any(abs(angle - corridor.angle) < SAME_ANGLE for corridor in corridors)
        if not known and math.cos(angle) > LEAST_AHEAD:
            corridors.append(corridor_at(angle, target, pushing.half_width))
    # The fan's angles are the same in every state, the paper's is not: each by themselves, what is known of the arm is kept.
    papers = int(isinstance(problem, PushProblem))
    grasps = [
        *pushing.grasps_along(state, corridors[:papers], rejects),
        *pushing.grasps_along(state, corridors[papers:], rejects),
    ]
    return [_drive(pushing, state, *each) for each in zip(corridors, grasps, strict=True)]


def _is_retrievable(pushing: Pushing, state: State) -> bool:
    """Whether the target is to be retrieved, and stands."""
    upright = state.conditions[pushing.scene.target_index] is Condition.UPRIGHT
    return upright and isinstance(pushing.task.goal, Retrieve)


def _drive(pushing: Pushing, state: State, corridor: Corridor, grasp: Grasp | Infeasible) -> Drive:
    blockers = grasp.blockers if isinstance(grasp, Infeasible) else ()
    return Drive(pushing.problem_along(state, corridor, blockers), grasp)
