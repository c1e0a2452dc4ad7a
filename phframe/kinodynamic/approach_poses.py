"""From where an object can be pushed to a place: from behind it, and from both its sides."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from phframe.core import FloatArray, rotated_in_plane, rotation_matrix

SIDES = {"behind": math.pi, "its left": math.pi / 2.0, "its right": -math.pi / 2.0}
"""Where the fingertip stands, seen from the object along the way to its place (rad)."""
BESIDE = 0.03
"""Distance of the fingertip from the edge of an object that it is to push (m)."""


def approach_poses(
    center: FloatArray, place: FloatArray, distance: float, most_yaw: float
) -> Iterator[tuple[str, FloatArray]]:
    """Up to three fingertip poses ``(3,)`` beside an object, each with a name, looking at it as far as the yaw allows.

    Source: Papallas and Dogar (2020).

    Args:
        center: Of the object ``(2,)`` (m).
        place: Where it is to go ``(2,)`` (m).
        distance: Of the fingertip from the centre (m).
        most_yaw: Greatest yaw to either side (rad).
    """
    along = (place - center) / math.hypot(*(place - center))
    for name, angle in SIDES.items():
        away = rotated_in_plane(along, rotation_matrix(angle).T)
        yaw = math.atan2(-float(away[1]), abs(float(away[0])))
        yield name, np.array([*(center + distance * away), min(max(yaw, -most_yaw), most_yaw)])
