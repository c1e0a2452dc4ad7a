"""Where steering led, control after control: snapshots of the planning world by index, which is all a search carries."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.core import FloatArray, Motion, Shelf, State, Steering, Stop, Transition
from phframe.kinodynamic.faults import fault_of

NOTHING = Motion(0.0)
"""What happened before the first control."""
IN_ROOM = 0.15
"""How far before the mouth the fingertip may be (m)."""
MOST_YAW = 0.7
"""Greatest yaw of the gripper to either side (rad)."""


@dataclass(frozen=True, slots=True)
class Controls:
    """The controls that a search may choose from: twists of the fingertip in the shelf frame, each held for one step.

    Attributes:
        speed: Greatest magnitude of each component of the velocity (m/s).
        turn_speed: Greatest rate of the yaw (rad/s).
        step: How long a control is held (s).
    """

    speed: float = 0.1
    turn_speed: float = 0.1
    step: float = 1.0

    @property
    def limits(self) -> FloatArray:
        """Greatest magnitude of each component of a twist ``(3,)``."""
        return np.array([self.speed, self.speed, self.turn_speed])


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """Where the fingertip may be steered.

    Attributes:
        lower: Least x, y (m), yaw (rad) ``(3,)``.
        upper: Greatest x, y, yaw ``(3,)``.
    """

    lower: FloatArray
    upper: FloatArray

    @classmethod
    def of(cls, shelf: Shelf) -> Room:
        """From a little before the mouth of a shelf to its walls, the gripper turned no farther than it can push."""
        return cls(np.array([-IN_ROOM, 0.0, -MOST_YAW]), np.array([shelf.depth, shelf.width, MOST_YAW]))

    def with_pose(self, pose: FloatArray) -> Room:
        """The room, made large enough to hold a pose ``(3,)``."""
        return Room(np.minimum(self.lower, pose), np.maximum(self.upper, pose))

    def holds(self, pose: FloatArray) -> bool:
        """Whether a pose ``(3,)`` lies in it."""
        return bool(((self.lower <= pose) & (pose <= self.upper)).all())


@dataclass(frozen=True, slots=True, eq=False)
class SteeredNode:
    """Where a control led.

    Attributes:
        snapshot: The world then, moving or not; opaque.
        state: What it holds, its speeds aside.
        parent: Index of the node that the control was held from; None: the root.
        twist: The control ``(3,)`` (m/s, m/s, rad/s); None: the root's.
        motion: What happened.
        fault: Why nothing goes on from here; empty: it may.
    """

    snapshot: Any
    state: State
    parent: int | None = None
    twist: FloatArray | None = None
    motion: Motion = NOTHING
    fault: str = ""

    @property
    def pose(self) -> FloatArray:
        """Of the fingertip ``(3,)``: x, y (m), yaw (rad)."""
        assert self.state.arm is not None, "what is steered is not parked"
        return self.state.arm.gripper


class SteeredTree:
    """A tree of controls held one after another. It grows by ``extend``, and no node ever changes.

    Args:
        steering: Of the task.
        snapshot: The root.
        controls: For the length of a step.
        room: Where the fingertip may be.
        opening: Distance between the fingers at the end of the first step (m).
    """

    def __init__(self, steering: Steering[Any], snapshot: Any, controls: Controls, room: Room, opening: float) -> None:
        self._steering, self._controls, self._room, self._opening = steering, controls, room, opening
        self._nodes = [SteeredNode(snapshot, steering.state_of(snapshot))]

    def __len__(self) -> int:
        return len(self._nodes)

    def __getitem__(self, index: int) -> SteeredNode:
        return self._nodes[index]

    @property
    def tried(self) -> int:
        """How many controls were tried, those that lead out of the room among them."""
        return len(self._nodes) - 1

    def extend(self, index: int, twist: FloatArray) -> int:
        """Hold a control from a node for one step; the index of where it leads.

        Where it leads out of the room nothing is simulated: the new node is as the old one, and has a fault.

        Raises:
            BudgetExceededError: If the task's budget is spent.
        """
        self._nodes.append(self._led(index, np.array(twist)))
        return len(self._nodes) - 1

    def branch(self, index: int) -> list[int]:
        """Indices of the nodes from the root to one of them."""
        return list(self._upwards(index))[::-1]

    def twists(self, index: int) -> FloatArray:
        """The controls ``(k, 3)`` that lead from the root to a node."""
        rows = [self._nodes[row].twist for row in self.branch(index)[1:]]
        return np.array(rows, dtype=np.float64).reshape(-1, 3)

    def motion(self, index: int) -> Motion:
        """What happened on the way from the root to a node."""
        whole = NOTHING
        for row in self.branch(index)[1:]:
            whole = whole.then(self._nodes[row].motion)
        return whole

    def _led(self, index: int, twist: FloatArray) -> SteeredNode:
        start, step = self._nodes[index], self._controls.step
        if not self._room.holds(start.pose + twist * step):
            return SteeredNode(start.snapshot, start.state, index, twist, fault="out of the room for the fingertip")
        snapshot, motion = self._steering.propagate(
            start.snapshot, twist, step, opening=self._opening, stop=Stop(wall=True)
        )
        state = self._steering.state_of(snapshot)
        fault = fault_of(start.state, Transition(state, motion), at_rest=False)
        return SteeredNode(snapshot, state, index, twist, motion, fault)

    def _upwards(self, index: int) -> Iterator[int]:
        row: int | None = index
        while row is not None:
            yield row
            row = self._nodes[row].parent
