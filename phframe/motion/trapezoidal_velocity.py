"""Trapezoidal velocity profiles: the quickest motion from rest to rest at limited speed and acceleration."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from phframe.core import FloatArray


@dataclass(frozen=True, slots=True)
class TrapezoidalProfile:
    """A fraction of a leg, 0 to 1, over time: constant acceleration, full speed, constant deceleration.

    Source: K. Lynch and F. Park, "Modern Robotics", 2017, section 9.2.2.2; a triangle where full speed is not reached.

    Attributes:
        peak: Greatest rate (1/s).
        rising: How long it takes to get there, and to come to rest again (s).
        duration: Of the whole leg (s).
    """

    peak: float
    rising: float
    duration: float

    def times(self, spacing: float) -> FloatArray:
        """Times ``(k,)`` from 0 to the end at most ``spacing`` (s) apart, the changes of acceleration among them."""
        corners = [0.0, self.rising, self.duration - self.rising, self.duration]
        spans = [np.linspace(a, b, math.ceil((b - a) / spacing - 1e-9) + 1) for a, b in pairwise(corners)]
        return np.concatenate([[0.0], *(span[1:] for span in spans if span[-1] > span[0] + 1e-9)])

    def fraction(self, times: FloatArray) -> FloatArray:
        """How far along the leg one is ``(k,)``."""
        t, left = np.minimum(times, self.rising), np.maximum(times - self.duration + self.rising, 0.0)
        cruising = np.clip(times - self.rising, 0.0, self.duration - 2.0 * self.rising)
        steepness = self.peak / self.rising
        # a t^2 / 2 while it gets faster, v t at full speed, v t - a t^2 / 2 while it gets slower
        return np.asarray(steepness * t**2 / 2.0 + self.peak * (cruising + left) - steepness * left**2 / 2.0)

    def rate(self, times: FloatArray) -> FloatArray:
        """How fast one goes along the leg ``(k,)`` (1/s)."""
        return np.asarray(self.peak * np.clip(np.minimum(times, self.duration - times) / self.rising, 0.0, 1.0))


def trapezoidal_profile(at_full_speed: float, to_full_speed: float) -> TrapezoidalProfile:
    """The quickest profile.

    Args:
        at_full_speed: What the leg takes at full speed (s), above 0.
        to_full_speed: What it takes to get from rest to full speed (s), above 0.
    """
    if at_full_speed >= to_full_speed:
        return TrapezoidalProfile(1.0 / at_full_speed, to_full_speed, at_full_speed + to_full_speed)
    rising = math.sqrt(at_full_speed * to_full_speed)
    return TrapezoidalProfile(1.0 / rising, rising, 2.0 * rising)
