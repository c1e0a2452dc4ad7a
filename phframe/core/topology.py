"""The interface of engines that compute 0-dimensional persistent homology of points."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar

import numpy as np

from phframe.core.options import Options
from phframe.core.value import FloatArray, Floats, IntArray, Value

FLOAT32_SLACK = 1e-4
"""Added to a radius (m) before distances are compared with it, since engines report deaths as float32."""


@dataclass(frozen=True, slots=True, eq=False)
class PersistenceDiagram(Value):
    """The 0-dimensional persistence diagram of the Vietoris-Rips filtration of points, coefficients Z2.

    A component's death is the distance between centres (not half of it) at which it merges into an older one.

    Attributes:
        births: ``(k,)`` metres, all 0 for points.
        deaths: ``(k,)`` metres, ascending; the last is infinite, for the component that never dies. Bars of no length
            (points that coincide) are left out.
    """

    births: Floats
    deaths: Floats

    def __post_init__(self) -> None:
        self._freeze("births", "deaths")

    @property
    def finite_deaths(self) -> FloatArray:
        """The deaths that are finite, ascending (m)."""
        return self.deaths[np.isfinite(self.deaths)]


OptionsT = TypeVar("OptionsT", bound=Options)


class TopologyEngine(ABC, Generic[OptionsT]):
    """Computes persistence diagrams and the components at a radius. Stateless."""

    options_type: ClassVar[type[Options]] = Options

    def __init__(self, options: OptionsT) -> None:
        self.options = options

    @abstractmethod
    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        """The diagram of points ``(n, 2)`` (m); empty for no points, one infinite bar for a single one."""

    def components(self, points: FloatArray, radius: float) -> IntArray:
        """Labels ``(n,)`` of the components at a radius (m): single linkage at distance <= radius.

        Labels count from 0 in the order in which components first appear among the points.
        """
        distance = np.linalg.norm(points[:, None, :] - points[None, :, :], axis=2)
        near = distance <= radius + FLOAT32_SLACK
        labels = np.full(len(points), -1, dtype=np.int64)
        for seed in range(len(points)):
            if labels[seed] < 0:
                labels[_connected(near, seed)] = labels.max() + 1
        return labels


def _connected(near: np.ndarray[tuple[int, ...], np.dtype[np.bool_]], seed: int) -> IntArray:
    """Indices of everything that can be reached from ``seed`` through near neighbours."""
    reached = near[seed]
    while True:
        grown = near[reached].any(axis=0)
        if (grown == reached).all():
            return np.flatnonzero(reached)
        reached = grown
