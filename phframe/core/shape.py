"""What objects are shaped like: all that planning and physics need to know of a shape, in one place.

Engines, exporters and recorders turn a shape into their own primitive by a ``match`` on its class that ends in
``UnknownShapeError``: a new shape is a new class here and one case in each of them.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Literal

import numpy as np

from phframe.core.value import FloatArray

FACETS = 32
"""Corners of the polygon around a round outline."""


class Shape(ABC):
    """An upright solid that stands on the board. Its frame has the origin at its centre, z up. Metres.

    A subclass is a frozen dataclass with a ``kind``, by which files name it.
    """

    __slots__ = ()

    kind: str
    """What files call it."""
    height: float
    """From the board to its top (m)."""

    @property
    @abstractmethod
    def bounding_radius(self) -> float:
        """Radius (m) of the smallest upright cylinder about the origin that holds the shape."""

    @property
    @abstractmethod
    def outline(self) -> FloatArray:
        """Corners ``(k, 2)`` of the convex outline seen from above, counter-clockwise (m); of a round one, around it."""

    @property
    @abstractmethod
    def area(self) -> float:
        """Of the outline (m^2)."""

    @abstractmethod
    def support(self, direction: FloatArray) -> float:
        """Support function h(d) = max over its points p of p . d, for a unit vector ``(2,)`` in its frame (m)."""

    @property
    def landmarks(self) -> FloatArray:
        """Points ``(k, 2)`` in its frame that stand for it when objects are grouped by persistent homology: its centre (m)."""
        return np.zeros((1, 2))

    @abstractmethod
    def inertia(self, mass: float) -> FloatArray:
        """Moments of inertia ``(3,)`` about its axes x, y, z for a mass (kg), evenly dense (kg m^2)."""

    @abstractmethod
    def figures(self) -> dict[str, float]:
        """Its dimensions by name (m): what must be positive and finite."""


@dataclass(frozen=True, slots=True)
class Cylinder(Shape):
    """An upright cylinder.

    Attributes:
        radius: Metres.
        height: Metres.
    """

    radius: float
    height: float = 0.12
    kind: Literal["cylinder"] = "cylinder"

    @property
    def bounding_radius(self) -> float:
        """Its radius (m)."""
        return self.radius

    @property
    def outline(self) -> FloatArray:
        """A regular polygon around the circle ``(FACETS, 2)`` (m)."""
        angles = np.arange(FACETS) * (math.tau / FACETS)
        return self.radius / math.cos(math.pi / FACETS) * np.column_stack([np.cos(angles), np.sin(angles)])

    @property
    def area(self) -> float:
        """Pi r^2 (m^2)."""
        return math.pi * self.radius**2

    def support(self, direction: FloatArray) -> float:
        """Its radius, whatever the direction (m)."""
        return self.radius

    def inertia(self, mass: float) -> FloatArray:
        """M (r^2 / 4 + h^2 / 12) about x and y, m r^2 / 2 about z (kg m^2)."""
        across = mass * (self.radius**2 / 4.0 + self.height**2 / 12.0)
        return np.array([across, across, mass * self.radius**2 / 2.0])

    def figures(self) -> dict[str, float]:
        """Radius and height (m)."""
        return {"radius": self.radius, "height": self.height}
