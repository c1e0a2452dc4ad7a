"""The paper's path region and the rectangle around a component: plain data in a frame of their own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from phframe.core.pose import rotation_matrix
from phframe.core.value import FloatArray, Floats, Value

Side = Literal["north", "south"]


@dataclass(frozen=True, slots=True, eq=False)
class Corridor(Value):
    """The strip that must be empty before the target can be reached (path region, Algorithm 1).

    The corridor frame has its origin at a mouth corner and its x axis along the strip.

    Attributes:
        origin: ``(2,)`` of the corridor frame in the shelf frame (m).
        angle: Of the corridor frame's x axis (rad): the incidence angle phi, positive towards the north.
        axis: y of the strip's centre line in the corridor frame (m).
        half_width: Of the strip, w (m).
        start: x of the gripper in the corridor frame, where the strip begins (m).
        end: x of the target in the corridor frame, where it ends (m).
        beside: The side wall the target is close to, or None where the strip is straight.
    """

    origin: Floats
    angle: float
    axis: float
    half_width: float
    start: float
    end: float
    beside: Side | None = None

    def __post_init__(self) -> None:
        self._freeze("origin")

    def to_local(self, points: FloatArray) -> FloatArray:
        """Points ``(..., 2)`` of the shelf frame in the corridor frame."""
        return np.asarray((points - self.origin) @ rotation_matrix(self.angle))

    def to_shelf(self, points: FloatArray) -> FloatArray:
        """Points ``(..., 2)`` of the corridor frame in the shelf frame."""
        return np.asarray(points @ rotation_matrix(self.angle).T + self.origin)

    def contains(self, points: FloatArray) -> NDArray[np.bool_]:
        """Mask ``(n,)`` of the centres ``(n, 2)``, in the shelf frame, that lie in the strip."""
        local = self.to_local(points)
        ahead = (local[:, 0] >= self.start) & (local[:, 0] < self.end)
        return np.asarray(ahead & (np.abs(local[:, 1] - self.axis) <= self.half_width))


@dataclass(frozen=True, slots=True, eq=False)
class Rectangle(Value):
    """The smallest axis-parallel rectangle around a component's centres (CRCCC, Algorithm 2), in the corridor frame.

    Attributes:
        lower: ``(2,)`` least x and y (m).
        upper: ``(2,)`` greatest x and y (m).
    """

    lower: Floats
    upper: Floats

    def __post_init__(self) -> None:
        self._freeze("lower", "upper")

    @property
    def center(self) -> FloatArray:
        """``(2,)`` in the corridor frame (m)."""
        return (self.lower + self.upper) / 2.0

    @property
    def corners(self) -> FloatArray:
        """``(4, 2)`` counter-clockwise in the corridor frame (m)."""
        (x0, y0), (x1, y1) = self.lower, self.upper
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


@dataclass(frozen=True, slots=True)
class Sweep:
    """A pushing action in numbers (Algorithm 3), in the corridor frame.

    Attributes:
        direction: +1 bottom to top (towards the north), -1 top to bottom.
        depth: x at which the fingertip sweeps (m).
        lane: y at which it begins to (m).
        end: y at which it ends (m).
        entry: How far the arm goes straight in before it sweeps (m).
        exit: How far it draws straight out afterwards (m).
        tilt: Of the arm against the corridor (rad); the paper's sweeps have none.
    """

    direction: Literal[1, -1]
    depth: float
    lane: float
    end: float
    entry: float
    exit: float
    tilt: float = 0.0

    @property
    def waypoints(self) -> FloatArray:
        """``(4, 2)`` fingertip positions: before the mouth, inserted, swept, out (m)."""
        ahead = np.array([math.cos(self.tilt), math.sin(self.tilt)])
        inserted, swept = np.array([self.depth, self.lane]), np.array([self.depth, self.end])
        return np.array([inserted - self.entry * ahead, inserted, swept, swept - self.exit * ahead])
