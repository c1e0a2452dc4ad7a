"""The paper's path region and the rectangle around a component: plain data in a frame of their own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from phframe.core.pose import turn
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
        return np.asarray((points - self.origin) @ turn(self.angle))

    def to_shelf(self, points: FloatArray) -> FloatArray:
        """Points ``(..., 2)`` of the corridor frame in the shelf frame."""
        return np.asarray(points @ turn(self.angle).T + self.origin)

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
        lane: y along which the arm goes in (m).
        depth: x to which the fingertip goes in (m).
        end: y to which it sweeps (m).
        retreat: x at which it is out again (m).
    """

    direction: Literal[1, -1]
    lane: float
    depth: float
    end: float
    retreat: float

    @property
    def waypoints(self) -> FloatArray:
        """``(4, 2)`` fingertip positions: before the mouth, inserted, swept, out (m)."""
        return np.array(
            [[self.retreat, self.lane], [self.depth, self.lane], [self.depth, self.end], [self.retreat, self.end]]
        )
