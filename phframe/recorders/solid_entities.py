"""Primitives and surfaces as Rerun's archetypes."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr

from phframe.recorders import palette
from phframe.recorders.bodies import Primitive, Surface, normals
from phframe.recorders.frames import quaternions_xyzw


def solid(shape: Primitive | Surface, color: palette.Color | None = None) -> Any:
    """A shape in the frame of its entity; without a colour where that is logged later, by ``recolored``."""
    if isinstance(shape, Primitive):
        return _primitive(shape, color)
    return rr.Mesh3D(
        vertex_positions=shape.vertices,
        vertex_normals=normals(shape),
        triangle_indices=shape.triangles,
        albedo_factor=color,
    )


def recolored(shape: Primitive, color: palette.Color) -> Any:
    """Only the colour of what is logged as a solid."""
    return type(_primitive(shape, color)).from_fields(colors=[color])


def _primitive(shape: Primitive, color: palette.Color | None) -> Any:
    look: dict[str, Any] = {
        "centers": [shape.pose[:3]],
        "quaternions": [quaternions_xyzw(shape.pose)],
        "colors": color,
        "fill_mode": "solid",
    }
    match shape.kind:
        case "box":
            return rr.Boxes3D(half_sizes=np.array([shape.size]) / 2.0, **look)
        case "cylinder":
            radius, length = shape.size
            return rr.Cylinders3D(radii=[radius], lengths=[length], **look)
        case _:
            return rr.Ellipsoids3D(half_sizes=np.full((1, 3), shape.size[0]), **look)
