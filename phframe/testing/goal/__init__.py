"""Checks of goals."""

from __future__ import annotations

from typing import Any

from phframe.core import Goal
from phframe.testing.check import Report, run_checks
from phframe.testing.goal.checks import GOAL_CHECKS
from phframe.testing.subjects import GoalUnderTest

__all__ = ["GOAL_CHECKS", "check_goal"]


def check_goal(goal: Goal[Any]) -> Report:
    """Check that a goal keeps to ``Goal``.

    Raises:
        ConformanceError: With every check that failed.
    """
    return run_checks(GoalUnderTest(goal), GOAL_CHECKS)
