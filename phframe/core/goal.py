"""What is to be achieved, when it is, and when it is lost."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar

from phframe.core.action import Action
from phframe.core.motion import Motion
from phframe.core.options import Options
from phframe.core.scene import Scene
from phframe.core.state import State
from phframe.core.status import Status
from phframe.core.trajectory import Trajectory
from phframe.core.value import Value


@dataclass(frozen=True, slots=True, eq=False)
class Attempt(Value):
    """An action that was carried out, or simulated.

    Attributes:
        action: The action.
        motion: What happened.
        trajectory: What was driven; None: not known.
    """

    action: Action
    motion: Motion
    trajectory: Trajectory | None = None


@dataclass(frozen=True, slots=True)
class Assessment:
    """How far a world is from a goal.

    Attributes:
        status: How far it got.
        reason: Why no farther, for people; empty where the goal is met.
        lost: Whether it can no longer be met, so that planning again is of no use.
    """

    status: Status
    reason: str = ""
    lost: bool = False


OptionsT = TypeVar("OptionsT", bound=Options)


class Goal(ABC, Generic[OptionsT]):
    """What is to be achieved in a scene. Stateless: it judges what it is shown, by one measure for every planner."""

    options_type: ClassVar[type[Options]] = Options

    def __init__(self, options: OptionsT) -> None:
        self.options = options

    def grasped(self, scene: Scene) -> str | None:
        """Id of the object that has to be grasped for the goal to be met; None: none, or it depends. By default None."""
        return None

    @abstractmethod
    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        """Judge a world.

        Args:
            scene: The scene.
            state: The world at rest, as it is or as it is expected.
            last: What was done last; None: nothing yet.
        """
