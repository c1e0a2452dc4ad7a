"""Persistence diagrams from Ripser (Bauer 2021), through ripser.py (Tralie, Saul and Bar-On 2018).

This calls ripser.py's compiled module. The Python function in front of it would bring in scikit-learn and matplotlib,
which takes a second in every process, and half of a small diagram's time; a test holds the two equal.
"""

from __future__ import annotations

import numpy as np
from pyRipser import doRipsFiltrationDM  # type: ignore[import-not-found, unused-ignore]  # it ships no types

from phframe.core.options import Options
from phframe.core.topology import PersistenceDiagram, TopologyEngine
from phframe.core.value import FloatArray
from phframe.topology.distances import pairwise_distances

HIGHEST_DIMENSION = 0
FIELD = 2  # coefficients Z2


class Ripser(TopologyEngine[Options]):
    """The default engine: the one of the paper."""

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        """The diagram of points ``(n, 2)`` (m). Deaths are the distances rounded to float32.

        Raises:
            InputError: If the points are not ``(n, 2)`` or not finite.
        """
        distances = pairwise_distances(points)
        if len(points) == 0:  # Ripser takes no distances to mean one point
            return PersistenceDiagram(np.empty(0), np.empty(0))
        found = doRipsFiltrationDM(distances, HIGHEST_DIMENSION, np.inf, FIELD, False)
        bars = np.array(found["births_and_deaths_by_dim"][0]).reshape(-1, 2)
        return PersistenceDiagram(bars[:, 0], np.sort(bars[:, 1]))
