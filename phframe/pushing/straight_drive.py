"""The straight drive at the target, and the first object that it meets: the blocker of GRTC (Papallas and Dogar 2020)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from phframe.core import (
    Action,
    ActionKind,
    Condition,
    Contacts,
    FloatArray,
    GripperPath,
    Infeasible,
    Phase,
    State,
    Stop,
    StopCause,
    rotated_in_plane,
    rotation_matrix,
)
from phframe.geometry.arm_view import ArmView, arm_view
from phframe.geometry.straight_motion import distances_on_way_in
from phframe.pushing.grasp import Grasp
from phframe.pushing.pushing import Pushing


@dataclass(frozen=True, slots=True)
class StraightDrive:
    """The straight drive from before the mouth to the grasp pose: the reach of a grasp, as if only the target stood there.

    So it goes along the corridor's axis with the fingers open; near a wall it is turned, or the fingers open less wide.

    Attributes:
        action: The drive. It is simulated to see what it meets.
        grasp: What it becomes where it meets nothing: reach, grasp and withdrawal.
        view: The arm with its fingers as wide open as on the drive.
    """

    action: Action
    grasp: Grasp
    view: ArmView

    @property
    def tip(self) -> FloatArray:
        """The fingertip's last pose ``(3,)`` in the shelf frame: x, y (m), yaw (rad)."""
        return np.asarray(self.action.path.poses[-1])

    def meets(self, points: FloatArray, radii: float | FloatArray) -> NDArray[np.bool_]:
        """Mask ``(n,)`` of the discs around points ``(n, 2)`` of the shelf frame (m) that the arm sweeps over on its way.

        Safe: what is not met here is not touched by the drive.

        Args:
            points: Centres of the discs.
            radii: Of the discs ``(n,)``, or of each of them (m).
        """
        start, end = self.action.path.poses
        local = rotated_in_plane(points - end[:2], rotation_matrix(float(end[2])))
        length = math.hypot(*(end[:2] - start[:2]))
        return np.asarray(distances_on_way_in(local, *self.view.boxes, length).min(axis=0) < radii)


def straight_drive(pushing: Pushing, state: State) -> StraightDrive | Infeasible:
    """The straight drive at the target, where it is in a state; why there is none.

    Args:
        pushing: The task's geometry, with the planner's options.
        state: The world at rest.
    """
    problem = pushing.problem(_emptied(state, pushing.scene.target_index))
    grasp = problem if isinstance(problem, Infeasible) else pushing.grasp(problem)
    if isinstance(grasp, Infeasible):
        return grasp
    path, scene = grasp.action.path, pushing.scene
    rule = replace(path.rules[Phase.REACH], contacts=Contacts.OBJECTS)
    drive = GripperPath(path.poses[:2], (Phase.REACH,), {Phase.REACH: rule})
    view = arm_view(scene.shelf, pushing.task.arm, rule.opening, pushing.options.neighbour_clearance)
    return StraightDrive(Action(f"drive straight at {scene.target}", drive, kind=ActionKind.MOVE), grasp, view)


def first_blocker(pushing: Pushing, state: State, drive: StraightDrive | None = None) -> str | Infeasible | None:
    """Id of the first object that the straight drive at the target meets, in simulation; None: it reaches the target.

    Counts as one simulated action.

    Args:
        pushing: The task's geometry, with the planner's options.
        state: The world at rest.
        drive: The ``straight_drive`` of that state, where it is known; None: it is worked out.

    Returns:
        The id, None, or why there is no straight drive.

    Raises:
        BudgetExceededError: If the task's budget is spent.
    """
    found = drive or straight_drive(pushing, state)
    if isinstance(found, Infeasible):
        return found
    obstacles = frozenset(pushing.scene.ids) - {pushing.scene.target}
    motion = pushing.task.apply(state, found.action, stop=Stop(bodies=obstacles)).motion
    if motion.complete:
        return None
    if motion.stopped is not None and motion.stopped.cause is StopCause.CONTACT:
        return motion.stopped.body
    why = motion.stopped or f"stalled at {motion.largest_force:.0f} N"
    return Infeasible(f"the straight drive at the target ended early: {why}")


def _emptied(state: State, target: int) -> State:
    """A state as if nothing but the target stood on the board."""
    kept = (each if row == target else Condition.SPILLED for row, each in enumerate(state.conditions))
    return replace(state, conditions=tuple(kept))
