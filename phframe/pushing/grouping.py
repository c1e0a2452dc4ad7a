"""The closest component and its rectangle (CRCCC, Algorithm 2)."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray, IntArray, Rectangle


def closest_component(local: FloatArray, labels: IntArray, axis: float) -> IntArray:
    """Indices of the component that holds the obstacle nearest to the gripper along the corridor.

    Args:
        local: Centres ``(n, 2)`` in the corridor frame (m), at least one.
        labels: Component of each, ``(n,)``.
        axis: y of the corridor's centre line (m); of obstacles equally near, the one nearest to it counts.
    """
    nearest = np.lexsort((np.abs(local[:, 1] - axis), local[:, 0]))[0]
    return np.flatnonzero(labels == labels[nearest])


def bounding_rectangle(local: FloatArray) -> Rectangle:
    """The smallest axis-parallel rectangle around centres ``(n, 2)`` in the corridor frame."""
    return Rectangle(local.min(axis=0), local.max(axis=0))
