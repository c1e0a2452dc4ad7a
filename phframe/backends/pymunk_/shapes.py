"""Turns the shape of an object into pymunk's primitive, and into what its friction with the board is: one match."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.backends.pymunk_.chipmunk import ChipmunkBody, ChipmunkSpace, Handle, circle
from phframe.core import Cylinder, Shape, UnknownShapeError


@dataclass(frozen=True, slots=True)
class Footprint:
    """An object as the plane has it.

    Attributes:
        body: Where it is.
        primitive: Its outline, made for its body and not in the space yet.
        spin_limit: Most that its friction with the board resists turning with (Nm).
        edge: Distance from its centre at which it may stand on single points (m).
    """

    body: ChipmunkBody
    primitive: Handle
    spin_limit: float
    edge: float


def footprint(space: ChipmunkSpace, shape: Shape, mass: float, friction: float) -> Footprint:
    """The footprint of a shape of some mass (kg) that slides with some friction (N), on a new body in a space.

    A disc under even pressure resists turning with the integral of mu p r over its area, 2/3 mu m g R (Goyal, Ruina and
    Papadopoulos, Planar sliding with dry friction, Wear 143, 1991).

    Raises:
        UnknownShapeError: If the engine has no primitive for it.
    """
    match shape:
        case Cylinder(radius=radius):
            body = space.body(mass, mass * radius * radius / 2.0)
            return Footprint(body, circle(body, radius), friction * radius * 2.0 / 3.0, radius)
        case _:
            raise UnknownShapeError(shape, "the pymunk backend")
