"""PHIA: persistent homology informed actions (Algorithm 4)."""

from __future__ import annotations

from typing import Literal

from phframe.core import FloatArray, Plan, Planner, Task
from phframe.pushing import Clearing, ClearingOptions, Deviation, usable_radii


class PHIAOptions(ClearingOptions):
    """Options of PHIA.

    Attributes:
        radius: Which of the usable radii groups the obstacles; the paper takes the smallest.
    """

    radius: Literal["smallest", "largest"] = "smallest"


class PHIA(Planner[PHIAOptions]):
    """Sweeps the closest component at the smallest persistent radius that leaves room to insert, until the target is free."""

    options_type = PHIAOptions

    def search(self, task: Task) -> Plan:
        """Greedy: one action per configuration, no search tree."""
        return Clearing(task, self.options, self._choose_radius).run()

    def _choose_radius(self, deaths: FloatArray, threshold: float) -> tuple[float, tuple[Deviation, ...]]:
        """The smallest (or largest) usable radius; where there is none, the threshold h."""
        radii = usable_radii(deaths, self.options.margin, threshold)
        if not len(radii):
            return threshold, (Deviation.FALLBACK_RADIUS,)
        return float(radii[0 if self.options.radius == "smallest" else -1]), ()
