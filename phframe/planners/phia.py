"""PHIA: persistent homology informed actions (Algorithm 4)."""

from __future__ import annotations

from phframe.core import FloatArray, Plan, Planner, Task
from phframe.pushing import Clearing, Deviation, PushingOptions, usable_radii


class PHIA(Planner[PushingOptions]):
    """Sweeps the closest component at the smallest persistent radius that leaves room to insert, until the target is free."""

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Greedy: one action per configuration, no search tree."""
        return Clearing(task, self.options, self._choose_radius).run()

    def _choose_radius(self, deaths: FloatArray, threshold: float) -> tuple[float, tuple[Deviation, ...]]:
        """The smallest usable radius; where there is none, the threshold h."""
        radii = usable_radii(deaths, self.options.margin, threshold)
        return (float(radii[0]), ()) if len(radii) else (threshold, (Deviation.FALLBACK_RADIUS,))
