"""How far a plan or an episode got."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """How far it got."""

    ACHIEVED = "achieved"
    """The goal is met, where it is another one than to retrieve an object."""
    RETRIEVED = "retrieved"
    """The target is out of the shelf and in the hand."""
    REACHED = "reached"
    """The gripper was at a grasp pose with the link free (the paper's success), but did not bring the target out."""
    CLEARED = "cleared"
    """The corridor is empty."""
    FAILED = "failed"
    """Nothing was found, or the goal was lost; the reason says why."""
    TIMEOUT = "timeout"
    """The budget ran out first."""

    @property
    def is_success(self) -> bool:
        """Whether the goal is met."""
        return self in (Status.ACHIEVED, Status.RETRIEVED)
