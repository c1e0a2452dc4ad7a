"""The interface of motion planners: what turns a gripper path into joints that reach it without hitting anything."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Generic, Protocol, TypeVar, runtime_checkable

import numpy as np

from phframe.core.arm import ArmModel
from phframe.core.errors import IncompatibleError
from phframe.core.gripper_path import GripperPath
from phframe.core.options import Options
from phframe.core.scene import Scene
from phframe.core.shelf import BasePose
from phframe.core.state import State
from phframe.core.trajectory import JointTrajectory
from phframe.core.unreachable import Unreachable

OptionsT = TypeVar("OptionsT", bound=Options)


class MotionPlanner(ABC, Generic[OptionsT]):
    """Plans joint trajectories for one arm at one base pose in one scene."""

    options_type: ClassVar[type[Options]] = Options

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: OptionsT) -> None:
        self.scene, self.arm, self.base_pose, self.options = scene, arm, base_pose, options

    @abstractmethod
    def plan(
        self, path: GripperPath, state: State, *, attempts: int, seconds: float, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """Plan a joint trajectory for a path.

        Inside the shelf the fingertip follows the path in the gripper plane; how the arm gets from where it is to the
        path's first pose is up to the planner, and may leave that plane. The speeds of the path's rules are upper
        bounds, and its rules say what may be touched.

        Args:
            path: Where the gripper is to go.
            state: Where the objects and the arm are.
            attempts: How often to try anew; this is what ends a search, repeatably.
            seconds: Time after which a hopeless search ends all the same; the result then says so (``timed_out``).
            rng: The only source of randomness.
        """


@runtime_checkable
class SupportsMotionPlanning(Protocol):
    """What an arm offers that backends which drive joints can move."""

    def motion_planner(self, scene: Scene, base_pose: BasePose) -> MotionPlanner[Any]:
        """What plans joint trajectories for the gripper's paths, in a scene and with the base at a pose."""


def motion_planner_of(arm: ArmModel[Any], scene: Scene, base_pose: BasePose) -> MotionPlanner[Any]:
    """The motion planner of an arm.

    Raises:
        IncompatibleError: If it has none.
    """
    if isinstance(arm, SupportsMotionPlanning):
        return arm.motion_planner(scene, base_pose)
    raise IncompatibleError(
        f"{type(arm).__name__} has no motion planner, so no backend that drives joints can move it: "
        "take the backend pymunk, or another arm, such as planar"
    )
