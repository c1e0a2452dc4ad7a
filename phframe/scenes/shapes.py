"""The shapes of objects in files: in our scene files, as MuJoCo's geoms, and in URDF."""

from __future__ import annotations

from phframe.core import Cylinder, Shape, UnknownShapeError
from phframe.urdf.solids import Solid


def figures_of(shape: Shape) -> dict[str, float | str]:
    """A shape as a scene file has it: its kind and dimensions (m).

    Raises:
        UnknownShapeError: If scene files know no such shape.
    """
    match shape:
        case Cylinder():
            return {"shape": shape.kind, "radius": float(shape.radius), "height": float(shape.height)}
        case _:
            raise UnknownShapeError(shape, "the writer of scene files")


def geom_of(shape: Shape) -> tuple[str, tuple[float, ...]]:
    """Type and size (m) of the MJCF geom that a shape is.

    Raises:
        UnknownShapeError: If the export knows no such shape.
    """
    match shape:
        case Cylinder():
            return "cylinder", (shape.radius, shape.height / 2.0)
        case _:
            raise UnknownShapeError(shape, "the export to MJCF")


def solid_of(shape: Shape) -> Solid:
    """The URDF primitive that a shape is.

    Raises:
        UnknownShapeError: If the export knows no such shape.
    """
    match shape:
        case Cylinder():
            return Solid("cylinder", (float(shape.radius), float(shape.height)))
        case _:
            raise UnknownShapeError(shape, "the export to URDF")
