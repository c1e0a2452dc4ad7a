"""The paper's path region (Algorithm 1): straight, or at an incidence angle where the target is close to a side wall."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from phframe.core import ArmShape, Corridor, FloatArray, Infeasible, Scene, Shelf

AUTO_CLEARANCE = 0.004
"""Left on either side (m) when the half-width is derived from the arm."""


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
