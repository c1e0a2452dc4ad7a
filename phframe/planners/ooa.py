"""OOA: one object at a time, the baseline without grouping."""

from __future__ import annotations

from phframe.core import Plan, Planner, Task
from phframe.pushing import Clearing, ClearingOptions

SINGLE_OBJECTS = 0.01
"""A radius (m) at which no two objects are in one component."""


class OOA(Planner[ClearingOptions]):
    """PHIA with a radius so small that every object is a component of its own."""

    options_type = ClearingOptions

    def search(self, task: Task) -> Plan:
        """Sweep the closest object until the target is free."""
        return Clearing(task, self.options, lambda deaths, threshold: (SINGLE_OBJECTS, ())).run()
