"""What the checks are run on: an implementation, and what it needs to be tried."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    Goal,
    GripperTrajectory,
    JointTrajectory,
    Physics,
    Planner,
    Scene,
    Shelf,
    State,
    Task,
    TopologyEngine,
)
from phframe.testing.tolerances import PLANAR, PhysicsTolerances

DEFAULT_SHELF = Shelf(depth=0.594, width=0.584)
"""The shelf of the published scenes."""

PhysicsFactory = Callable[[Scene, ArmModel[Any], BasePose], Physics[Any]]
"""Makes a new backend; ``lambda scene, arm, base_pose: MyPhysics(scene, arm, base_pose, MyOptions())``."""

PlanTrajectory = Callable[[GripperTrajectory, State, ArmModel[Any], BasePose], JointTrajectory]
"""Finds the joints for a gripper trajectory that begins in a state."""


MakeTask = Callable[..., Task]
"""From a scene and what else a ``Task`` takes to a task."""


@dataclass(frozen=True, slots=True)
class EngineUnderTest:
    """A topology engine.

    Attributes:
        engine: The engine.
    """

    engine: TopologyEngine[Any]

    def __str__(self) -> str:
        return type(self.engine).__name__


@dataclass(frozen=True, slots=True)
class GoalUnderTest:
    """A goal.

    Attributes:
        goal: The goal.
    """

    goal: Goal[Any]

    def __str__(self) -> str:
        return type(self.goal).__name__


@dataclass(frozen=True, slots=True)
class ArmUnderTest:
    """An arm in front of a shelf.

    Attributes:
        arm: The arm.
        shelf: The shelf.
        samples: How many joint values are tried.
    """

    arm: ArmModel[Any]
    shelf: Shelf = DEFAULT_SHELF
    samples: int = 30

    def __str__(self) -> str:
        return type(self.arm).__name__

    def joint_values(self) -> FloatArray:
        """Joint values ``(samples, dof)`` within limits, the same ones every time."""
        lower, upper = np.array([[joint.lower, joint.upper] for joint in self.arm.joints]).T
        return np.asarray(np.random.default_rng(7).uniform(lower, upper, (self.samples, len(lower))))


@dataclass(frozen=True, slots=True)
class PhysicsUnderTest:
    """A physics backend with an arm.

    Attributes:
        factory: Makes a new backend.
        arm: The arm.
        tolerances: How exact the backend has to be.
        plan_trajectory: Plans joint trajectories, for a backend that executes those.
        name: Of the backend, for messages.
    """

    factory: PhysicsFactory
    arm: ArmModel[Any]
    tolerances: PhysicsTolerances = PLANAR
    plan_trajectory: PlanTrajectory | None = None
    name: str = field(default="the backend")

    def __str__(self) -> str:
        return f"{self.name} with {type(self.arm).__name__}"


@dataclass(frozen=True, slots=True)
class PlannerUnderTest:
    """A planner, and the tasks it is tried on.

    Attributes:
        planner: The planner.
        make_task: From a scene and what else a ``Task`` takes (``start``, ``budget``, ``rejected``, ``seed``) to a task.
    """

    planner: Planner[Any]
    make_task: MakeTask

    def __str__(self) -> str:
        return type(self.planner).__name__
