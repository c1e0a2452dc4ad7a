"""At which angles, and how deep, the arm that executes can grasp the target at all, were nothing in its way."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from phframe.core import Action, Condition, FloatArray, State, Task
from phframe.pushing.fan import SAME_ANGLE, Drive, drives
from phframe.pushing.grasp import FITS, REJECTED, Grasp, GraspFinder, Rejects
from phframe.pushing.pushing import Pushing

ASIDE = 10.0
"""How far away the obstacles are put (m)."""
NEARBY = 0.01
"""A target that is nearer than this (m) to where it stood is reached as it was there."""
NO_GRASP_BESIDE, LESS_DEEP_BESIDE = math.radians(5.5), math.radians(15.5)
"""Where the arm can grasp at no depth, nor can it turned by up to the first (rad); where less deep, nor deeper up to the second."""
LESS_DEEP = 0.001
"""Fits that differ by less than this in depth are one (m)."""
BEYOND = "it is beyond the arm"


@dataclass(frozen=True, slots=True, eq=False)
class _Known:
    """What is known of the arm's reach for the target at one place.

    Attributes:
        place: Of the target ``(2,)`` (m).
        drives: Whether the arm can grasp along a drive, by the drive's angle (rad).
        depths: How far past the middle of the target the fingertips may go at most (m), by the gripper's yaw (rad).
    """

    place: FloatArray
    drives: dict[float, bool] = field(default_factory=dict)
    depths: dict[float, float] = field(default_factory=dict)


class ReachOfTarget:
    """Asked once a grasp turned out to be beyond the arm: then in the shelf without obstacles.

    Of the fits of the gripper around the target, the deepest that the arm can follow is found.

    Args:
        task: The task.
        pushing: Its geometry.
        fan: The angles at which the target is driven at (rad).
    """

    def __init__(self, task: Task, pushing: Pushing, fan: Sequence[float]) -> None:
        self._task, self._pushing, self._fan = task, pushing, fan
        turned = pushing.options
        straight = turned.model_copy(update={"max_grasp_turn": 0.0})
        self._finders = [GraspFinder(pushing.scene, task.arm, options) for options in (straight, turned)]
        self._known: list[_Known] = []
        self._questions = 0
        self.never = ""
        """Why the arm reaches the target at no angle where it stands at the start; empty: it does, or nobody asked yet."""

    @property
    def questions(self) -> int:
        """How often the arm was asked."""
        return self._questions

    def refuses(self, drive: Drive) -> bool:
        """Whether no grasp along a drive is within the arm's reach, as far as is known."""
        known = self._at(drive.problem.state)
        return known is not None and _along(known, drive.angle) is False

    def rejects(self, state: State) -> Rejects:
        """Tells why a grasp from a state is not to be proposed: one as deep, at about its yaw, is beyond the arm."""
        known, target = self._at(state), self._target(state)

        def why(action: Action) -> str | None:
            if known is None:
                return None
            yaw, past = float(action.path.poses[1, 2]), _past(action, target)
            limits = (depth for angle, depth in known.depths.items() if abs(yaw - angle) <= _beside(depth))
            return BEYOND if any(past > depth for depth in limits) else None

        return why

    def ask(self, state: State, drive: Drive, action: Action) -> None:
        """Find out what an arm can do that could not follow a grasp along a drive.

        Nothing, where it could if the obstacles were gone. Else how deep it can grasp along the drive; where not at all,
        whether it can along another.
        """
        known, alone = self._known_at(state), _alone(state, self._pushing.scene.target_index)
        if not (why := self._ask(known, action, alone)):
            return
        if drive.angle not in known.drives:
            why = self._ask_along(known, drive, alone) and why
            others = drives(self._pushing, alone, self._fan) if why else []
            for other in others if isinstance(others, list) else ():
                if why and isinstance(other.grasp, Grasp):
                    why = self._ask_along(known, other, alone) and why
            if why and np.array_equal(known.place, self._target(self._task.start)):
                self.never = f"the arm cannot grasp the target at any angle, even in an empty shelf: {why}"

    def _ask_along(self, known: _Known, drive: Drive, alone: State) -> str:
        """Why the arm cannot grasp along a drive, each fit less deep than the one before; empty: it can.

        The gripper is turned only where walls want it so.
        """
        reached, why = _along(known, drive.angle), ""
        for finder in self._finders if reached is None else ():
            found = finder.grasp(alone, drive.problem.corridor, self.rejects(alone))
            while isinstance(found, Grasp) and (why := self._ask(known, found.action, alone)):
                found = finder.grasp(alone, drive.problem.corridor, self.rejects(alone))
            if (reached := isinstance(found, Grasp)) or found is REJECTED:
                break
        known.drives[drive.angle] = bool(reached)
        return "" if reached else why or BEYOND

    def _ask(self, known: _Known, action: Action, alone: State) -> str:
        """Why the arm cannot follow a grasp, which is noted; empty: it can."""
        self._questions += 1
        unreachable = self._task.reachable(action, alone)
        if unreachable is None:
            return ""
        yaw, less = float(action.path.poses[1, 2]), _past(action, self._target(alone)) - LESS_DEEP
        known.depths[yaw] = min(known.depths.get(yaw, math.inf), less)
        return unreachable.why

    def _known_at(self, state: State) -> _Known:
        """What is known where the target stands in a state, to be added to."""
        known = self._at(state)
        if known is None:
            known = _Known(self._target(state).copy())
            self._known.append(known)
        return known

    def _at(self, state: State) -> _Known | None:
        """What is known where the target stands in a state; None: nothing."""
        target = self._target(state)
        return next((known for known in self._known if math.dist(known.place, target) <= NEARBY), None)

    def _target(self, state: State) -> FloatArray:
        found: FloatArray = state.positions[self._pushing.scene.target_index]
        return found


def _along(known: _Known, angle: float) -> bool | None:
    return next((reached for other, reached in known.drives.items() if abs(angle - other) < SAME_ANGLE), None)


def _beside(depth: float) -> float:
    """Up to which turn a depth at one yaw holds for others (rad)."""
    return NO_GRASP_BESIDE if depth < min(past for past, _ in FITS) - LESS_DEEP / 2.0 else LESS_DEEP_BESIDE


def _past(action: Action, target: FloatArray) -> float:
    """How far past the middle of the target the fingertips of a grasp go (m)."""
    x, y, yaw = action.path.poses[1].tolist()
    return float((x - target[0]) * math.cos(yaw) + (y - target[1]) * math.sin(yaw))


def _alone(state: State, target: int) -> State:
    """A state in which the obstacles are gone."""
    poses = state.poses.copy()
    gone = np.arange(len(poses)) != target
    poses[gone, 0] -= ASIDE
    conditions = tuple(Condition.SPILLED if away else was for away, was in zip(gone, state.conditions, strict=True))
    return replace(state, poses=poses, conditions=conditions).parked()
