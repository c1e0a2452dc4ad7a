"""What a planner may use besides the world that it plans in."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core import NOBODY, Advisor
from phframe.runtime.confirmation import Confirmation
from phframe.runtime.particles import Particles


@dataclass(frozen=True, slots=True)
class Aids:
    """What a planner may use besides the world that it plans in.

    Attributes:
        advisor: Whom it may ask.
        confirmation: Simulates in an engine like that of the execution; None: that is the one it plans in.
        particles: Samples of what the world may be; None: what it believes of it is certain.
    """

    advisor: Advisor = NOBODY
    confirmation: Confirmation | None = None
    particles: Particles | None = None

    @property
    def motion_planning_time(self) -> float:
        """Wall time spent on motion planning so far (s)."""
        return 0.0 if self.confirmation is None else self.confirmation.motion_planning_time
