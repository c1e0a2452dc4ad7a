"""Turns the shape of an object into MuJoCo's primitive: one match."""

from __future__ import annotations

from typing import Any

import mujoco

from phframe.core import Cylinder, Shape, UnknownShapeError


def primitive(shape: Shape) -> dict[str, Any]:
    """Type and size of the geom that a shape is, its origin at the centre; MuJoCo wants halves of lengths.

    Raises:
        UnknownShapeError: If the engine has no primitive for it.
    """
    match shape:
        case Cylinder(radius=radius, height=height):
            return {"type": mujoco.mjtGeom.mjGEOM_CYLINDER, "size": [radius, height / 2.0, 0.0]}
        case _:
            raise UnknownShapeError(shape, "the MuJoCo backend")
