"""Turns the shape of an object into PyBullet's collision shape: one match."""

from __future__ import annotations

from phframe.backends.pybullet_.output_capture import bullet
from phframe.core import Cylinder, Shape, UnknownShapeError


def collision_shape(client: int, shape: Shape) -> int:
    """A collision shape of a client, its origin at the centre.

    Raises:
        UnknownShapeError: If the engine has no primitive for it.
    """
    match shape:
        case Cylinder(radius=radius, height=height):
            made: int = bullet.createCollisionShape(
                bullet.GEOM_CYLINDER, radius=radius, height=height, physicsClientId=client
            )
            return made
        case _:
            raise UnknownShapeError(shape, "the PyBullet backend")
