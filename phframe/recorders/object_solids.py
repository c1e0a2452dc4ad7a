"""What recordings and videos draw for each shape of object: the one place that tells shapes apart."""

from __future__ import annotations

from phframe.core import Cylinder, Shape, UnknownShapeError
from phframe.recorders.bodies import Primitive

RECORDING = "the recording"


def primitive_of(shape: Shape) -> Primitive:
    """An object's solid, in its own frame.

    Raises:
        UnknownShapeError: If nothing is known to draw for the shape.
    """
    match shape:
        case Cylinder(radius, height):
            return Primitive("cylinder", (radius, height))
        case _:
            raise UnknownShapeError(shape, RECORDING)


def disc_radius(shape: Shape) -> float:
    """Radius (m) of the disc that an object is, seen from the top.

    Raises:
        UnknownShapeError: If it is none.
    """
    match shape:
        case Cylinder(radius, _):
            return radius
        case _:
            raise UnknownShapeError(shape, RECORDING)
