"""The closest component and its rectangle (CRCCC, Algorithm 2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phframe.core import FloatArray, Floats, IntArray, Value


@dataclass(frozen=True, slots=True, eq=False)
class Rectangle(Value):
    """The smallest axis-parallel rectangle around a component's centres (CRCCC, Algorithm 2), in the corridor frame.

    Attributes:
        lower: ``(2,)`` least x and y (m).
        upper: ``(2,)`` greatest x and y (m).
    """

    lower: Floats
    upper: Floats

    def __post_init__(self) -> None:
        self._freeze("lower", "upper")

    @property
    def center(self) -> FloatArray:
        """``(2,)`` in the corridor frame (m)."""
        return (self.lower + self.upper) / 2.0

    @property
    def corners(self) -> FloatArray:
        """``(4, 2)`` counter-clockwise in the corridor frame (m)."""
        (x0, y0), (x1, y1) = self.lower, self.upper
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def closest_component(local: FloatArray, labels: IntArray, axis: float) -> IntArray:
    """Indices of the component that holds the obstacle nearest to the gripper along the corridor.

    Args:
        local: Centres ``(n, 2)`` in the corridor frame (m), at least one.
        labels: Component of each, ``(n,)``.
        axis: y of the corridor's centre line (m); of obstacles equally near, the one nearest to it counts.
    """
    nearest = np.lexsort((np.abs(local[:, 1] - axis), local[:, 0]))[0]
    return np.flatnonzero(labels == labels[nearest])


def merged_labels(labels: IntArray, owners: IntArray) -> IntArray:
    """The component of each owner, where an owner with points in several components makes them one.

    Args:
        labels: Component of each point ``(m,)``, counted in the order of first appearance.
        owners: Whose each point is ``(m,)``: 0, 0, 1, ... without a gap.

    Returns:
        ``(k,)``, counted in the order of first appearance among the owners.
    """
    joined, count = labels.copy(), int(owners.max(initial=-1)) + 1
    for owner in range(count if count < len(owners) else 0):
        own = joined[owners == owner]
        joined[np.isin(joined, own)] = own.min()
    firsts = joined[np.unique(owners, return_index=True)[1]]
    order = {label: number for number, label in enumerate(dict.fromkeys(firsts.tolist()))}
    return np.array([order[label] for label in firsts.tolist()], dtype=np.int64)


def bounding_rectangle(local: FloatArray) -> Rectangle:
    """The smallest axis-parallel rectangle around centres ``(n, 2)`` in the corridor frame."""
    return Rectangle(local.min(axis=0), local.max(axis=0))
