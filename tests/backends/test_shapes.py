"""Every engine refuses a shape that it has no primitive for, instead of taking it for another."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import pytest

from phframe.core import FloatArray, Scene, SceneObject, Shelf, UnknownShapeError
from phframe.core.shape import Shape
from tests.backends.engines import ARM, each_engine, physics


@dataclass(frozen=True, slots=True)
class Prism(Shape):
    """An upright triangular prism, which no engine has a case for."""

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


@each_engine
def test_engines_of_joints_refuse_an_unknown_shape(engine: str) -> None:
    with pytest.raises(UnknownShapeError, match="backend has no primitive for the shape 'prism'"):
        physics(engine, SCENE).restore(SCENE.initial_state())


def test_pymunk_refuses_an_unknown_shape() -> None:
    from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics

    backend = PymunkPhysics(SCENE, ARM, ARM.default_base_pose(SCENE.shelf), PymunkOptions())
    with pytest.raises(UnknownShapeError, match="the pymunk backend"):
        backend.restore(SCENE.initial_state())
