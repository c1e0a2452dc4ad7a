"""Checks of arms."""

from __future__ import annotations

from typing import Any

from phframe.core import ArmModel, Shelf
from phframe.testing.arm.geometry import GEOMETRY_CHECKS
from phframe.testing.arm.kinematics import KINEMATICS_CHECKS
from phframe.testing.arm.urdf import URDF_CHECKS
from phframe.testing.check import Check, Report, run_checks
from phframe.testing.subjects import DEFAULT_SHELF, ArmUnderTest

__all__ = ["ARM_CHECKS", "check_arm"]

ARM_CHECKS: tuple[Check[ArmUnderTest], ...] = (*KINEMATICS_CHECKS, *GEOMETRY_CHECKS, *URDF_CHECKS)


def check_arm(arm: ArmModel[Any], shelf: Shelf = DEFAULT_SHELF) -> Report:
    """Check that an arm keeps to ``ArmModel``, in front of a shelf.

    Raises:
        ConformanceError: With every check that failed.
    """
    return run_checks(ArmUnderTest(arm, shelf), ARM_CHECKS)
