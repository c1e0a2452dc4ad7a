"""Where the gripper is to go, before anyone has said when: polylines of gripper poses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from phframe.core.errors import InputError
from phframe.core.value import Floats, Value

MOUTH_CLEARANCE = 0.05
"""An arm is out of the shelf when all of it is farther than this (m) before the mouth plane."""


MOST_LEGS = 10_000
"""Of a path: one every tenth of a millimetre, on a way of a metre."""
LEAST_AHEAD = 0.2
"""Least cosine of an arm's yaw: one turned further from the mouth neither comes in through it nor leaves by it."""


class Phase(StrEnum):
    """What a leg of a path is for."""

    APPROACH = "approach"
    INSERT = "insert"
    SWEEP = "sweep"
    RETREAT = "retreat"
    REACH = "reach"
    GRASP = "grasp"
    WITHDRAW = "withdraw"
    PLACE = "place"
    """Carries what is held to where it is to stand."""
    RELEASE = "release"
    """Opens the fingers and lets go of it."""


class Contacts(StrEnum):
    """What the arm may touch during a phase. It may never touch a wall."""

    NONE = "none"
    MANIPULAND = "manipuland"
    """The object that the path grasps, carries or places."""
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
        manipuland: Id of the object that is grasped, carried or placed; None: the path handles nothing.
        overrides: Rules of single legs, by index, that differ from their phase's: a speed of its own for a leg.

    Raises:
        InputError: If there is no leg, or too many, the lengths disagree, a number is not finite, a phase has no rule, or a
            rule is for a leg that does not exist.
    """

    poses: Floats
    phases: tuple[Phase, ...]
    rules: Mapping[Phase, PhaseRule]
    manipuland: str | None = None
    overrides: Mapping[int, PhaseRule] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._freeze("poses")
        if not 0 < len(self.phases) <= MOST_LEGS:
            raise InputError(f"a gripper path needs at least one leg, and at most {MOST_LEGS}, not {len(self.phases)}")
        if self.poses.shape != (len(self.phases) + 1, 3):
            raise InputError(
                f"a path of {len(self.phases)} legs needs {len(self.phases) + 1} poses (x, y, yaw), not {self.poses.shape}"
            )
        if not np.isfinite(self.poses).all():
            raise InputError("a gripper path holds a pose that is not a finite number")
        if missing := set(self.phases) - set(self.rules):
            raise InputError(f"a gripper path says no speed for: {', '.join(sorted(missing))}")
        if strange := sorted(set(self.overrides) - set(range(len(self.phases)))):
            raise InputError(f"a path of {len(self.phases)} legs has no leg {strange[0]} to give a rule to")

    def rule(self, leg: int) -> PhaseRule:
        """How a leg is driven: as its own rule has it, else as its phase's."""
        return self.overrides.get(leg) or self.rules[self.phases[leg]]

    def shifted(self, offset: ArrayLike) -> GripperPath:
        """The same path moved by ``(3,)`` x, y (m) and yaw (rad)."""
        return replace(self, poses=self.poses + np.asarray(offset))


def controlled_path(start: ArrayLike, twists: ArrayLike, dt: float, phase: Phase, rule: PhaseRule) -> GripperPath:
    """The path of a fingertip that holds one twist after another, each for the same time.

    Args:
        start: Pose ``(3,)``: x, y (m), yaw (rad).
        twists: ``(k, 3)`` m/s, m/s, rad/s in the shelf frame, none of them zero.
        dt: How long each is held (s).
        phase: Of all legs.
        rule: Opening, contacts and finger speed of all legs; the speeds are those of the twists.

    Raises:
        InputError: If a twist is zero: a path has no leg in which nothing moves.
    """
    steps = np.asarray(twists, dtype=np.float64)
    poses = np.vstack([start, np.asarray(start) + np.cumsum(steps * dt, axis=0)])
    speeds = zip(np.hypot(steps[:, 0], steps[:, 1]).tolist(), np.abs(steps[:, 2]).tolist(), strict=True)
    rules = {leg: _held(rule, speed, turn_speed) for leg, (speed, turn_speed) in enumerate(speeds)}
    return GripperPath(poses, (phase,) * len(steps), {phase: rule}, overrides=rules)


def _held(rule: PhaseRule, speed: float, turn_speed: float) -> PhaseRule:
    """A rule by which neither moving nor turning ends before the other: what does not move has any speed."""
    if not (speed or turn_speed):
        raise InputError("a twist of a controlled path is zero: leave it out")
    return replace(rule, speed=speed or rule.speed, turn_speed=turn_speed or rule.turn_speed)
