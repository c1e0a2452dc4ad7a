"""A tree that grows where it is sparse: the expansive space tree of Hsu, Latombe and Motwani."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phframe.core import FloatArray

ROOT = -1
"""In place of the parent of a vertex that has none."""


class ExpansiveTree:
    """Vertices, their parents, and how many others are near each.

    Args:
        dof: Number of joints.
        radius: Vertices at most this far apart, by the Euclidean norm, are neighbours (rad or m).
    """

    def __init__(self, dof: int, radius: float) -> None:
        self.radius, self.size = radius, 0
        self._vertices, self._parents, self._neighbours = np.empty((64, dof)), np.empty(64, np.int64), np.empty(64)

    @property
    def vertices(self) -> FloatArray:
        """All vertices ``(size, dof)``, in the order in which they were added."""
        return self._vertices[: self.size]

    @property
    def parents(self) -> NDArray[np.int64]:
        """Of each vertex ``(size,)``; ROOT where there is none."""
        return self._parents[: self.size]

    @property
    def weights(self) -> FloatArray:
        """Of each vertex ``(size,)``: 1 / (neighbours + 1), in proportion to which it is picked."""
        return np.asarray(1.0 / (self._neighbours[: self.size] + 1.0))

    def picked(self, chance: float) -> int:
        """The vertex that an even chance in [0, 1) stands for."""
        ends = np.cumsum(self.weights)
        return min(int(np.searchsorted(ends, chance * ends[-1], side="right")), self.size - 1)

    def near(self, q: FloatArray, distance: float) -> NDArray[np.int64]:
        """The vertices at most a distance from ``q``, the nearest first."""
        squares = self._squares(q)
        (found,) = np.nonzero(squares <= distance**2)
        return found[np.argsort(squares[found], kind="stable")]

    def acceptance(self, q: FloatArray) -> float:
        """How probably a new vertex ``q`` is to be kept: 1 / neighbours, 1 where there are none."""
        return 1.0 / max(1, int(np.count_nonzero(self._squares(q) <= self.radius**2)))

    def add(self, q: FloatArray, parent: int = ROOT) -> int:
        """Add a vertex and tell its neighbours; returns its index."""
        if self.size == len(self._vertices):
            self._grow()
        near, new = self._squares(q) <= self.radius**2, self.size
        self._neighbours[:new] += near
        self._vertices[new], self._parents[new], self._neighbours[new] = q, parent, np.count_nonzero(near)
        self.size += 1
        return new

    def branch(self, vertex: int) -> FloatArray:
        """The vertices ``(k, dof)`` from one back to the root it grew from."""
        indices = [vertex]
        while (parent := int(self._parents[indices[-1]])) != ROOT:
            indices.append(parent)
        return np.asarray(self._vertices[indices])

    def _squares(self, q: FloatArray) -> FloatArray:
        """Of the distances ``(size,)`` to ``q``."""
        apart = self.vertices - q
        return np.asarray(np.einsum("ij,ij->i", apart, apart))

    def _grow(self) -> None:
        self._vertices = np.concatenate([self._vertices, np.empty_like(self._vertices)])
        self._parents = np.concatenate([self._parents, np.empty_like(self._parents)])
        self._neighbours = np.concatenate([self._neighbours, np.empty_like(self._neighbours)])
