"""The paper's path region (Algorithm 1): straight, or at an incidence angle where the target is close to a side wall."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from phframe.core import (
    ArmShape,
    FloatArray,
    Floats,
    Infeasible,
    Scene,
    Shelf,
    Value,
    rotated_in_plane,
    rotation_matrix,
)

AUTO_CLEARANCE = 0.004
"""Left on either side (m) when the half-width is derived from the arm."""
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
        return rotated_in_plane(points - self.origin, rotation_matrix(self.angle))

    def to_shelf(self, points: FloatArray) -> FloatArray:
        """Points ``(..., 2)`` of the corridor frame in the shelf frame."""
        return rotated_in_plane(points, rotation_matrix(self.angle).T) + self.origin

    def contains(self, points: FloatArray) -> NDArray[np.bool_]:
        """Mask ``(n,)`` of the centres ``(n, 2)``, in the shelf frame, that lie in the strip."""
        local = self.to_local(points)
        ahead = (local[:, 0] >= self.start) & (local[:, 0] < self.end)
        return np.asarray(ahead & (np.abs(local[:, 1] - self.axis) <= self.half_width))


def corridor_half_width(setting: float | Literal["auto"], scene: Scene, arm: ArmShape) -> float:
    """The half-width w (m) that a setting stands for: itself, or what this arm and these obstacles need."""
    if setting != "auto":
        return setting
    radii = [item.radius for item in scene.objects if item.id != scene.target]
    return arm.link_width / 2.0 + max(radii, default=0.0) + AUTO_CLEARANCE


def find_corridor(target: FloatArray, shelf: Shelf, half_width: float) -> Corridor | Infeasible:
    """The strip that leads from the mouth to the target.

    Args:
        target: Centre ``(2,)`` of the target in the shelf frame (m).
        shelf: The shelf.
        half_width: w (m).
    """
    depth, y = float(target[0]), float(target[1])
    near_south, near_north = y < half_width, shelf.width - y < half_width
    if near_south and near_north:
        return Infeasible(
            f"the shelf is {shelf.width:g} m wide at the target, the corridor {2 * half_width:g} m; "
            "set half_width to less, or to auto"
        )
    if near_north:
        return _angled(depth, y, half_width, 0.0)
    if near_south:
        return _angled(depth, shelf.width - y, half_width, shelf.width)
    return Corridor(np.zeros(2), 0.0, y, half_width, 0.0, depth)


def corridor_at(angle: float, target: FloatArray, half_width: float, beyond: float = 0.0) -> Corridor:
    """The strip that leads from the mouth to the target at any angle.

    Its frame has its origin where its centre line crosses the mouth plane; it begins before that, so that no corner of it
    inside the shelf is left out.

    Args:
        angle: Of the strip (rad), positive towards the north.
        target: Centre ``(2,)`` of the target in the shelf frame (m).
        half_width: w (m).
        beyond: How far past the target's centre it leads (m).
    """
    ahead = np.array([math.cos(angle), math.sin(angle)])
    end = float(target[0]) / ahead[0]
    return Corridor(target - end * ahead, angle, 0.0, half_width, -half_width * abs(math.tan(angle)), end + beyond)


def with_room(corridor: Corridor, shelf: Shelf, centers: FloatArray, radii: FloatArray) -> Corridor:
    """A corridor, or the angled one in its place where there is no room between a straight one and the wall next to it.

    What stands in a straight strip on that wall's side could only be pushed where it is not outside the strip yet.

    Args:
        corridor: As Algorithm 1 has it.
        shelf: The shelf.
        centers: Of what is in the strip ``(k, 2)``, in the shelf frame (m).
        radii: Of the same ``(k,)`` (m).
    """
    y, w = corridor.axis, corridor.half_width
    if corridor.beside is not None:
        return corridor
    north = y > shelf.width / 2.0
    room = (shelf.width - y if north else y) - w
    at_wall = (centers[:, 1] >= y) if north else (centers[:, 1] <= y)
    if not (at_wall & (radii > room)).any():
        return corridor
    angled = _angled(corridor.end, y if north else shelf.width - y, w, 0.0 if north else shelf.width)
    return angled if isinstance(angled, Corridor) else corridor


def _angled(x: float, y: float, w: float, corner: float) -> Corridor | Infeasible:
    """Along the line through the mouth corner that passes the target at distance w: phi = atan2(y, x) - asin(w / |t|).

    Args:
        x: Depth of the target (m).
        y: Its distance from the mouth corner across the shelf (m).
        w: Half-width (m).
        corner: y of that corner in the shelf frame; 0 is south, anything else north, where all is mirrored.
    """
    distance = math.hypot(x, y)
    if distance < w:
        return Infeasible(f"the target is {distance:.3f} m from the mouth corner, nearer than the half-width {w:g} m")
    angle = math.atan2(y, x) - math.asin(w / distance)
    end = math.sqrt(distance * distance - w * w)
    if corner == 0.0:
        return Corridor(np.zeros(2), angle, w, w, 0.0, end, "north")
    return Corridor(np.array([0.0, corner]), -angle, -w, w, 0.0, end, "south")
