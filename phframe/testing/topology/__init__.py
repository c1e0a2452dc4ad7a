"""Checks of topology engines."""

from __future__ import annotations

from typing import Any

from phframe.core import TopologyEngine
from phframe.testing.check import Report, run_checks
from phframe.testing.subjects import EngineUnderTest
from phframe.testing.topology.checks import TOPOLOGY_CHECKS

__all__ = ["TOPOLOGY_CHECKS", "check_topology"]


def check_topology(engine: TopologyEngine[Any]) -> Report:
    """Check that a topology engine keeps to ``TopologyEngine``.

    Raises:
        ConformanceError: With every check that failed.
    """
    return run_checks(EngineUnderTest(engine), TOPOLOGY_CHECKS)
