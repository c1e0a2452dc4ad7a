"""A planner under watch: what it was given is as it was when it returns, and when it first had a plan is noted."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from phframe.core import Options, Plan, Planner, PluginError, Task

_GIVEN = ("scene", "start", "arm", "budget", "rejected")
"""What a task hands to the planner as data."""


class GuardedPlanner(Planner[Options]):
    """Plans as another planner does, and looks at it.

    Args:
        planner: The other planner.

    Attributes:
        first_solution_time: Planning time until the first plan of the first task that was worth carrying out (s); None:
            there was none.
    """

    def __init__(self, planner: Planner[Any]) -> None:
        super().__init__(Options())
        self.__wrapped__ = planner
        self._asked = False
        self.first_solution_time: float | None = None

    def search(self, task: Task) -> Plan:
        """The other planner's plan.

        Raises:
            PluginError: If the planner changed what it was given, or returned something else than a plan.
        """
        with task.paused():
            given = {name: deepcopy(getattr(task, name)) for name in _GIVEN}
        plan = self.__wrapped__.plan(task)
        with task.paused():
            changed = [name for name, value in given.items() if getattr(task, name) != value]
        if changed:
            raise PluginError(
                f"planner {type(self.__wrapped__).__name__} changed what it was given: {', '.join(changed)}. A planner may "
                "read its task, no more"
            )
        if not self._asked:
            self._asked = True
            offered = task.first_solution_time
            self.first_solution_time = plan.cost.total if offered is None and plan.succeeded else offered
        return plan
