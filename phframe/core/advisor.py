"""Who can be asked what to do next: a person in front of a terminal, a program, or what was answered before."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from phframe.core.scene import Scene
from phframe.core.state import State
from phframe.core.value import Floats, Value


@dataclass(frozen=True, slots=True)
class Hint:
    """What is to be moved next, and where to.

    Attributes:
        object: Id of the object.
        to: Where it is to stand: x, y in the shelf frame (m).
    """

    object: str
    to: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Question(Value):
    """What to move next, and where to?

    Attributes:
        scene: The scene.
        state: The world as it is where the hint is wanted.
        blocker: Id of the object that blocks the drive at the target.
        corridor: Corners ``(k, 2)`` of the way to the target that is to be free (m).
        refusal: Why the last answer could not be used; empty: there was none.
    """

    scene: Scene
    state: State
    blocker: str
    corridor: Floats
    refusal: str = ""

    def __post_init__(self) -> None:
        self._freeze("corridor")


class Advisor(Protocol):
    """Answers a planner's questions, in its own time: a task's budget does not run meanwhile."""

    def advise(self, question: Question) -> Hint | None:
        """The next hint; None: there is none, and the planner is to give up.

        Whether the hint can be used is looked at by the planner, which asks again with the reason where it cannot.
        """


class _Nobody:
    """Nobody is there to be asked."""

    def advise(self, question: Question) -> Hint | None:
        """No hint."""
        return None


NOBODY: Advisor = _Nobody()
"""Never has a hint."""
