"""A state seen along its corridor: which obstacles are to be pushed aside."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core import FloatArray, IntArray, State
from phframe.pushing.corridor import Corridor
from phframe.pushing.deviation import Deviation


@dataclass(frozen=True, slots=True, eq=False)
class PushProblem:
    """One state, its corridor and the obstacles that must go.

    Attributes:
        state: The world at rest.
        corridor: To the target, where it is now.
        members: Rows of the obstacles that count, ``(k,)``.
        local: Their centres ``(k, 2)`` in the corridor frame (m).
        blockers: Ids of those that count although they are not in the corridor: they block the grasp.
        deviations: Those that led to the corridor.
    """

    state: State
    corridor: Corridor
    members: IntArray
    local: FloatArray
    blockers: tuple[str, ...] = ()
    deviations: tuple[Deviation, ...] = ()
