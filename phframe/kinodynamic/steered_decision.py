"""Why a steered action was chosen, and what the search for it came to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from phframe.core import Decision, Floats
from phframe.core.value import frozen_floats


@dataclass(frozen=True, slots=True, eq=False)
class SteeredDecision(Decision):
    """Why an action made of steered controls was chosen. Fields that do not apply stay empty.

    Attributes:
        moved: Id of the object to be moved.
        place: Where it was to go ``(2,)`` (m).
        approach: Pose ``(3,)`` from which it was to be pushed: x, y (m), yaw (rad).
        controls: How many controls the searches tried.
        distance: How near the last search came to its goal (m).
        drift: Greatest distance between where an object was steered and where the whole action put it (m); the action is
            simulated in one go and settles, and what it makes of the state is what counts.
    """

    kind: ClassVar[str] = "steered"

    moved: str = ""
    place: Floats | None = None
    approach: Floats | None = None
    controls: int = 0
    distance: float | None = None
    drift: float | None = None

    def __post_init__(self) -> None:
        for name in ("place", "approach"):
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, frozen_floats(value))
