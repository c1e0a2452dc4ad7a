"""Straight edges in joint space: where they are looked at, and whether they are valid there."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from phframe.core import FloatArray
from phframe.core.value import frozen_floats

ROUNDING = 1e-9
"""Of a step: an edge as long as a whole number of them, but for rounding, has that number."""


class Edges:
    """Edges that are looked at in steps of equal length, their ends among them.

    A piece of a valid edge that is cut where it was looked at is looked at in the same places, so it is valid too.

    Args:
        valid: Whether a configuration ``(dof,)`` is allowed.
        resolution: Most that any one joint moves in a step (rad or m).
    """

    def __init__(self, valid: Callable[[FloatArray], bool], resolution: float) -> None:
        self.valid, self.resolution = valid, resolution

    def steps(self, start: FloatArray, end: FloatArray) -> int:
        """Into how many steps an edge is cut, at least one."""
        return max(1, math.ceil(float(np.abs(end - start).max()) / self.resolution - ROUNDING))

    def allowed(self, start: FloatArray, end: FloatArray) -> bool:
        """Whether the whole edge is valid but for its start, which is taken to be.

        The end comes first, then the middle, then the middles of the halves: what blocks it is met early.
        """
        places = start + bisection(self.steps(start, end)) * (end - start)
        places[0] = end  # to the last bit
        return all(map(self.valid, places))


@lru_cache(maxsize=1024)
def bisection(steps: int) -> FloatArray:
    """Fractions ``(steps, 1)`` of an edge: its end, then its inner places, the middle of what is widest open first."""
    order, open_spans = [steps], deque([(1, steps - 1)])
    while open_spans:
        first, last = open_spans.popleft()
        if first <= last:
            middle = (first + last) // 2
            order.append(middle)
            open_spans += [(first, middle - 1), (middle + 1, last)]
    return frozen_floats(np.array(order)[:, None] / steps)
