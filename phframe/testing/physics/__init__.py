"""Checks of physics backends."""

from __future__ import annotations

from typing import Any

from phframe.core import ArmModel
from phframe.testing.check import Check, Report, run_checks
from phframe.testing.physics.board import BOARD_CHECKS
from phframe.testing.physics.forces import FORCE_CHECKS
from phframe.testing.physics.grasps import GRASP_CHECKS
from phframe.testing.physics.many import MANY_CHECKS
from phframe.testing.physics.motions import MOTION_CHECKS
from phframe.testing.physics.propagation import PROPAGATION_CHECKS
from phframe.testing.physics.purity import PURITY_CHECKS
from phframe.testing.physics.states import STATE_CHECKS
from phframe.testing.subjects import PhysicsFactory, PhysicsUnderTest, PlanTrajectory
from phframe.testing.tolerances import PLANAR, PhysicsTolerances

__all__ = ["PHYSICS_CHECKS", "check_physics"]

PHYSICS_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    *STATE_CHECKS,
    *PURITY_CHECKS,
    *MOTION_CHECKS,
    *BOARD_CHECKS,
    *FORCE_CHECKS,
    *GRASP_CHECKS,
    *PROPAGATION_CHECKS,
    *MANY_CHECKS,
)


def check_physics(
    factory: PhysicsFactory,
    arm: ArmModel[Any],
    *,
    tolerances: PhysicsTolerances = PLANAR,
    plan_trajectory: PlanTrajectory | None = None,
    name: str = "the backend",
) -> Report:
    """Check that a backend keeps to ``Physics`` with an arm.

    Args:
        factory: Makes a new backend, as in ``lambda scene, arm, base_pose: MyPhysics(scene, arm, base_pose, MyOptions())``.
        arm: The arm.
        tolerances: ``PLANAR``, or ``SPATIAL`` for an engine in space, ``JOINTED`` with an arm of joints.
        plan_trajectory: Finds the joints for a gripper trajectory, where the backend executes those; None: straight on, by the
            arm's inverse kinematics.
        name: Of the backend, for messages.

    Raises:
        ConformanceError: With every check that failed.
    """
    return run_checks(PhysicsUnderTest(factory, arm, tolerances, plan_trajectory, name), PHYSICS_CHECKS)
