"""The world at rest: the currency between planners and physics, across backends."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from phframe.core.errors import InputError
from phframe.core.value import FloatArray, Floats, Value


class Condition(StrEnum):
    """What became of an object."""

    UPRIGHT = "upright"
    TOPPLED = "toppled"
    SPILLED = "spilled"
    """It left the board."""


@dataclass(frozen=True, slots=True, eq=False)
class ArmState(Value):
    """Where an arm is when it is not parked.

    Attributes:
        gripper: Fingertip pose (x, y, yaw) ``(3,)`` in the shelf frame (m, rad): what every backend understands.
        opening: Distance between the fingers (m).
        command: The distance they are told to have (m), less than ``opening`` while they squeeze something; a trajectory
            goes on from it. None: the same as ``opening``.
        joints: Joint values ``(dof,)`` (rad or m) where the backend has joints, else None. They count before ``gripper``.
    """

    gripper: Floats
    opening: float
    command: float | None = None
    joints: Floats | None = None

    @property
    def commanded_opening(self) -> float:
        """The distance the fingers are told to have (m)."""
        return self.opening if self.command is None else self.command

    def __post_init__(self) -> None:
        self._freeze("gripper")
        if self.gripper.shape != (3,):
            raise InputError(f"a gripper pose is (x, y, yaw), not of shape {self.gripper.shape}")
        if self.joints is not None:
            self._freeze("joints")


@dataclass(frozen=True, slots=True, eq=False)
class State(Value):
    """Every object's pose and condition, what is held, and where the arm is. Nothing moves.

    Attributes:
        poses: ``(n, 7)`` in the shelf frame, in the order of the scene's objects: x y z (m), qw qx qy qz. An object
            that spilled keeps the last pose it was seen at.
        conditions: One per object.
        held: Id of the object in the gripper, or None. Held until it is seen to be lost.
        arm: Where the arm is; None: parked outside the shelf, with nothing in the gripper.

    Raises:
        InputError: If the arrays disagree in length, or something is held by a parked arm.
    """

    poses: Floats
    conditions: tuple[Condition, ...]
    held: str | None = None
    arm: ArmState | None = None

    def __post_init__(self) -> None:
        self._freeze("poses")
        if self.poses.shape != (len(self.conditions), 7):
            raise InputError(
                f"{len(self.conditions)} objects need poses of shape ({len(self.conditions)}, 7), not {self.poses.shape}"
            )
        if self.held is not None and self.arm is None:
            raise InputError(f"{self.held!r} cannot be held by a parked arm")

    @property
    def positions(self) -> FloatArray:
        """Centres seen from above, ``(n, 2)`` (m)."""
        return self.poses[:, :2]

    @property
    def on_board(self) -> NDArray[np.bool_]:
        """Mask ``(n,)`` of the objects that have not spilled."""
        return np.array([condition is not Condition.SPILLED for condition in self.conditions])

    def parked(self) -> State:
        """The same world with the arm parked outside: what another arm or backend can start from.

        Raises:
            InputError: If something is held.
        """
        return replace(self, arm=None)

    def for_another_arm(self) -> State:
        """The same world as another arm or backend can take it up: the gripper where it is if it holds something, else parked."""
        if self.held is None or self.arm is None:
            return self.parked()
        return replace(self, arm=replace(self.arm, joints=None))

    def displacement(self, other: State) -> FloatArray:
        """Distance ``(n,)`` (m) by which each object's centre differs; infinite where its condition does."""
        distance = np.linalg.norm(self.poses[:, :3] - other.poses[:, :3], axis=1)
        changed = [a is not b for a, b in zip(self.conditions, other.conditions, strict=True)]
        return np.where(changed, np.inf, distance)
