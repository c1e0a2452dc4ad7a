"""Checks of planners."""

from __future__ import annotations

from typing import Any

from phframe.core import Planner
from phframe.testing.check import Report, run_checks
from phframe.testing.planner.checks import PLANNER_CHECKS, order_of_objects_does_not_matter
from phframe.testing.planner.tasks import simulated_tasks
from phframe.testing.subjects import MakeTask, PlannerUnderTest

__all__ = ["PLANNER_CHECKS", "check_planner", "order_of_objects_does_not_matter", "simulated_tasks"]


def check_planner(planner: Planner[Any], make_task: MakeTask | None = None, *, order_free: bool = False) -> Report:
    """Check that a planner keeps to ``Planner``.

    Args:
        planner: The planner.
        make_task: From a scene and ``seed``, ``start``, ``budget``, ``rejected`` to a task; None: those of
            ``simulated_tasks``, in the built-in physics with the built-in arm and topology engine.
        order_free: Whether it promises that the order of a scene's objects does not matter.

    Raises:
        ConformanceError: With every check that failed.
    """
    promised = (order_of_objects_does_not_matter,) if order_free else ()
    return run_checks(PlannerUnderTest(planner, make_task or simulated_tasks()), (*PLANNER_CHECKS, *promised))
