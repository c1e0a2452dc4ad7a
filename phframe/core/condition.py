"""When an object counts as toppled or spilled: one definition for every backend."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from phframe.core.pose import tilt_of
from phframe.core.state import Condition

TOPPLED_TILT = 0.5
"""An object that leans by more than this (rad) has toppled."""
BELOW_BOARD = -0.01
"""An object whose centre is lower than this (m) has left the board."""


def condition_of(pose: ArrayLike, *, held: bool) -> Condition:
    """What became of an object at a pose ``(7,)`` in the shelf frame.

    Spilled: not in the hand, and its centre is before the mouth or below the board.
    """
    x, _, z = np.asarray(pose, dtype=np.float64)[:3]
    if not held and (x < 0.0 or z < BELOW_BOARD):
        return Condition.SPILLED
    return Condition.TOPPLED if tilt_of(pose) > TOPPLED_TILT else Condition.UPRIGHT
