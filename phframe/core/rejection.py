"""An action that came to nothing, and why: what a planner is not to propose again."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core.action import Action
from phframe.core.unreachable import Unreachable
from phframe.core.value import Value


@dataclass(frozen=True, slots=True, eq=False)
class Rejection(Value):
    """An action that could not be carried out, or that came to nothing.

    Attributes:
        action: The action.
        reason: Why, for people.
        unreachable: Where the arm could not follow it, if that is why.
        plan: Index of the episode's plan it comes from.
    """

    action: Action
    reason: str
    unreachable: Unreachable | None = None
    plan: int = 0
