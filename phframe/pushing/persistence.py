"""Which radii persist, and which of those a gripper can use."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray

INSERTION_FACTOR = 1.1
"""How much wider than what is inserted the gap between two groups must be."""


def usable_threshold(insertion_width: float, largest_radius: float) -> float:
    """H (m): the distance between centres below which nothing can be inserted between two objects."""
    return INSERTION_FACTOR * insertion_width + 2.0 * largest_radius


def persistent_radii(deaths: FloatArray, margin: float) -> FloatArray:
    """The deaths that the next one follows by more than the margin nu; the last always counts.

    Args:
        deaths: Finite deaths ``(k,)``, ascending (m).
        margin: nu (m).
    """
    if len(deaths) == 0:
        return deaths
    persists = np.append(np.diff(deaths) > margin, True)
    return np.asarray(deaths[persists])


def usable_radii(deaths: FloatArray, margin: float, threshold: float) -> FloatArray:
    """The persistent radii above the threshold h, ascending (m)."""
    radii = persistent_radii(deaths, margin)
    return radii[radii > threshold]
