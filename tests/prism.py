"""A shape that no engine, exporter or recorder has a case for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from phframe.core import FloatArray, Scene, SceneObject, Shelf
from phframe.core.shape import Shape


@dataclass(frozen=True, slots=True)
class Prism(Shape):
    """An upright triangular prism."""

    side: float
    height: float = 0.12
    kind: Literal["prism"] = "prism"

    @property
    def bounding_radius(self) -> float:
        return self.side / math.sqrt(3.0)

    @property
    def outline(self) -> FloatArray:
        angles = np.array([0.0, 2.0, 4.0]) * np.pi / 3.0
        return self.bounding_radius * np.column_stack([np.cos(angles), np.sin(angles)])

    @property
    def area(self) -> float:
        return math.sqrt(3.0) / 4.0 * self.side**2

    def support(self, direction: FloatArray) -> float:
        return float((self.outline @ direction).max())

    def inertia(self, mass: float) -> FloatArray:
        across = mass * (self.side**2 / 24.0 + self.height**2 / 12.0)
        return np.array([across, across, mass * self.side**2 / 12.0])

    def figures(self) -> dict[str, float]:
        return {"side": self.side, "height": self.height}


PRISM: Any = Prism(0.05)
SCENE = Scene("prism", Shelf(0.5, 0.6), (SceneObject("t", PRISM, (0.3, 0.3)),), "t")
