"""What a plan is made of: a gripper path that says what it is for."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from phframe.core.errors import InputError
from phframe.core.gripper_path import GripperPath, Phase
from phframe.core.value import Value

SAME_POSITION, SAME_YAW = 1e-3, 5e-3
"""Actions whose paths differ by no more than this (m, rad) are the same for all that a robot can tell."""


class ActionKind(StrEnum):
    """What an action does."""

    PUSH = "push"
    """Moves objects aside, the fingers closed."""
    GRASP = "grasp"
    """Reaches for an object, closes the fingers on it and withdraws with it."""
    PLACE = "place"
    """Puts the object in the hand down, and lets go of it."""
    MOVE = "move"
    """Moves the arm, or what is in the hand, and touches nothing else."""


@dataclass(frozen=True, slots=True, eq=False)
class Action(Value):
    """A gripper path with a name, what it does, and the objects it means to move.

    Attributes:
        name: For people, such as ``sweep north object_1, object_4``.
        path: Where the gripper goes.
        moves: Ids of the objects it means to move.
        kind: What it does.

    Raises:
        InputError: If the path's phases are not those of the kind, or a grasp or a placement does not say of what.
    """

    name: str
    path: GripperPath
    moves: tuple[str, ...] = ()
    kind: ActionKind = ActionKind.PUSH

    def __post_init__(self) -> None:
        handled = kind_of(self.path.phases)
        if (handled or self.kind) is not self.kind or (handled is None and self.kind in _HANDLING):
            raise InputError(f"{self.name!r} is a {self.kind}, and its path has the phases {_listed(self.path.phases)}")
        if self.kind in _HANDLING and self.path.manipuland is None:
            raise InputError(f"{self.name!r} is a {self.kind}: its path must say of which object (manipuland)")

    def resembles(self, other: Action) -> bool:
        """Whether it is the same as another but for deviations below a millimetre: what came to nothing will again."""
        ours, theirs = self.path, other.path
        if (self.kind, self.moves, ours.phases) != (other.kind, other.moves, theirs.phases):
            return False
        apart = np.abs(ours.poses - theirs.poses).max(axis=0)
        return bool((apart[:2] <= SAME_POSITION).all() and apart[2] <= SAME_YAW)


_HANDLING = (ActionKind.GRASP, ActionKind.PLACE)


def kind_of(phases: tuple[Phase, ...]) -> ActionKind | None:
    """What phases that handle an object make of an action; None where nothing is handled."""
    if Phase.RELEASE in phases:
        return ActionKind.PLACE
    return ActionKind.GRASP if Phase.GRASP in phases else None


def _listed(phases: tuple[Phase, ...]) -> str:
    return ", ".join(phases)
