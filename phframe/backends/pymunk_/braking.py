"""The end of a trapezoidal velocity profile: how an arm brakes at the end of a leg, where what it pushed leaves it.

At full speed v for n - b steps and evenly slower for the last b, a leg of n steps is v (n - b / 2) long. With the same
length d and the braking a = v / b this gives b = n - sqrt(n^2 - 2 d / a) (lengths in m, times in steps; Siciliano et al.,
Robotics: Modelling, Planning and Control, 2009, section 4.2.1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pace:
    """The steps of one leg: at one speed, the last ones evenly slower down to rest; the leg takes as long as without.

    Attributes:
        braking: Number of the last steps, in which the arm brakes.
    """

    braking: int = 0

    def work(self, left: int) -> float:
        """How many steps at full speed go as far as the ``left`` last steps do."""
        return left - self.braking / 2.0 if left >= self.braking else left * left / (2.0 * self.braking)

    def steps(self, left: int) -> float:
        """How many steps, all as fast as the next one, go as far as the ``left`` last steps do."""
        work = self.work(left)
        return work / (work - self.work(left - 1))


def pace(distance: float, steps: int, acceleration: float) -> Pace:
    """The pace of a leg.

    Args:
        distance: How far it goes (m).
        steps: In how many steps, at least 1.
        acceleration: With which it brakes (m per step squared); where that is too little, it brakes all along.
    """
    longest = steps**2 - 2.0 * distance / acceleration
    return Pace(round(steps - math.sqrt(longest)) if longest > 0.0 else steps)
