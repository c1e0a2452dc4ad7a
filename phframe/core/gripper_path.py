"""Where the gripper is to go, before anyone has said when: polylines of gripper poses, and actions made of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from phframe.core.errors import InputError
from phframe.core.value import Floats, Value

MOUTH_CLEARANCE = 0.05
"""An arm is out of the shelf when all of it is farther than this (m) before the mouth plane."""


class Phase(StrEnum):
    """What a leg of a path is for."""

    APPROACH = "approach"
    INSERT = "insert"
    SWEEP = "sweep"
    RETREAT = "retreat"
    REACH = "reach"
    GRASP = "grasp"
    WITHDRAW = "withdraw"


class Contacts(StrEnum):
    """What the arm may touch during a phase. It may never touch a wall."""

    NONE = "none"
    TARGET = "target"
    OBJECTS = "objects"


@dataclass(frozen=True, slots=True)
class PhaseRule:
    """How the legs of one phase are driven.

    Attributes:
        speed: Of the fingertip (m/s).
        opening: Distance between the fingers at the end of each leg (m).
        contacts: What the arm may touch.
        turn_speed: Of the yaw (rad/s).
        finger_speed: Rate of the opening (m/s).
    """

    speed: float
    opening: float
    contacts: Contacts
    turn_speed: float = 1.0
    finger_speed: float = 0.1

    def __post_init__(self) -> None:
        for name in ("speed", "turn_speed", "finger_speed"):
            if not 0.0 < getattr(self, name) < math.inf:
                raise InputError(f"a phase's {name} must be a finite number above 0, not {getattr(self, name)!r}")
        if not 0.0 <= self.opening < math.inf:
            raise InputError(f"a phase's opening must be a finite number of 0 or more, not {self.opening!r}")


@dataclass(frozen=True, slots=True, eq=False)
class GripperPath(Value):
    """A polyline of fingertip poses with a phase for each leg.

    Attributes:
        poses: ``(m, 3)`` x, y (m) and yaw (rad) of the fingertip in the shelf frame. At yaw 0 the gripper looks along
            +x. Consecutive equal poses make a leg in which only the opening changes.
        phases: One per leg, ``m - 1``.
        rules: How each phase that occurs is driven.

    Raises:
        InputError: If there is no leg, the lengths disagree, a number is not finite, or a phase has no rule.
    """

    poses: Floats
    phases: tuple[Phase, ...]
    rules: Mapping[Phase, PhaseRule]

    def __post_init__(self) -> None:
        self._freeze("poses")
        if not self.phases:
            raise InputError("a gripper path needs at least one leg")
        if self.poses.shape != (len(self.phases) + 1, 3):
            raise InputError(
                f"a path of {len(self.phases)} legs needs {len(self.phases) + 1} poses (x, y, yaw), not {self.poses.shape}"
            )
        if not np.isfinite(self.poses).all():
            raise InputError("a gripper path holds a pose that is not a finite number")
        if missing := set(self.phases) - set(self.rules):
            raise InputError(f"a gripper path says no speed for: {', '.join(sorted(missing))}")


@dataclass(frozen=True, slots=True, eq=False)
class Action(Value):
    """A gripper path with a name and the objects it means to move.

    Attributes:
        name: For people, such as ``sweep north object_1, object_4``.
        path: Where the gripper goes.
        moves: Ids of the objects it means to move.
    """

    name: str
    path: GripperPath
    moves: tuple[str, ...] = ()

    @property
    def grasps(self) -> bool:
        """Whether it reaches for the target, grasps it and withdraws, rather than pushes."""
        return Phase.GRASP in self.path.phases
