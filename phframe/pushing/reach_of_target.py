"""At which angles the arm that executes can grasp the target at all, were nothing in its way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from phframe.core import Condition, Infeasible, State, Task
from phframe.pushing.fan import SAME_ANGLE, Drive, drives
from phframe.pushing.grasp import Grasp
from phframe.pushing.pushing import Pushing

ASIDE = 10.0
"""How far away the obstacles are put (m)."""


class ReachOfTarget:
    """Asked only once a grasp turned out to be beyond the arm: then at every angle, in the shelf without obstacles.

    Args:
        task: The task.
        pushing: Its geometry.
        fan: The angles at which the target is driven at (rad).
    """

    def __init__(self, task: Task, pushing: Pushing, fan: Sequence[float]) -> None:
        self._task, self._pushing, self._fan = task, pushing, fan
        self._beyond: list[float] | None = None
        self.never = ""
        """Why the arm reaches the target at no angle; empty: it does, or nobody asked yet."""

    def refuses(self, drive: Drive) -> bool:
        """Whether a drive is known to be beyond the arm."""
        return any(abs(drive.angle - angle) < SAME_ANGLE for angle in self._beyond or ())

    def ask(self, state: State) -> None:
        """Find out, after a grasp from a state was beyond the arm."""
        if self._beyond is not None:
            return
        self._beyond = []
        alone = _alone(state, self._pushing.scene.target_index)
        found = drives(self._pushing, alone, self._fan)
        if isinstance(found, Infeasible):
            return
        whys = [(drive, self._why(alone, drive)) for drive in found]
        self._beyond = [drive.angle for drive, why in whys if why]
        if all(why for _, why in whys):
            self.never = f"the arm cannot grasp the target at any angle, even in an empty shelf: {whys[0][1]}"

    def _why(self, alone: State, drive: Drive) -> str:
        if not isinstance(drive.grasp, Grasp):
            return drive.grasp.reason
        unreachable = self._task.reachable(drive.grasp.action, alone)
        return "" if unreachable is None else unreachable.why


def _alone(state: State, target: int) -> State:
    """A state in which the obstacles are gone."""
    poses = state.poses.copy()
    gone = np.arange(len(poses)) != target
    poses[gone, 0] -= ASIDE
    conditions = tuple(Condition.SPILLED if away else was for away, was in zip(gone, state.conditions, strict=True))
    return replace(state, poses=poses, conditions=conditions).parked()
