"""The interface of motion planners: what turns a gripper path into joints that reach it without hitting anything."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from phframe.core.gripper_path import GripperPath
from phframe.core.scene import Scene
from phframe.core.state import State
from phframe.core.trajectory import JointTrajectory
from phframe.core.value import FloatArray


@dataclass(frozen=True, slots=True)
class Unreachable:
    """A path that an arm cannot follow.

    Attributes:
        where: How far along the path it gets (m).
        why: The joint limit, the collision and with what, or the missing inverse.
    """

    where: float
    why: str


class MotionPlanner(ABC):
    """Plans joint trajectories for one arm at one mount."""

    @abstractmethod
    def plan(
        self, path: GripperPath, start: FloatArray, scene: Scene, state: State, seconds: float, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """Lift a path to joints.

        Args:
            path: Where the gripper is to go; how it gets to the path's first pose is up to the planner.
            start: Joint values ``(dof,)`` where the arm is.
            scene: The shelf.
            state: Where the objects are.
            seconds: Time allowed.
            rng: The only source of chance.
        """
