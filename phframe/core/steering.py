"""Steering the gripper at control level, for kinodynamic planners: hold a twist for a while, see what happens, go on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from phframe.core.motion import Motion
from phframe.core.physics import Stop, SupportsPropagation
from phframe.core.state import State
from phframe.core.value import FloatArray

SnapshotT = TypeVar("SnapshotT")
Begin = Callable[[State, FloatArray | None], Any]
"""Puts a state into the planning world, the fingertip at a pose ``(3,)`` or where it is, and gives its snapshot."""
Charge = Callable[[Callable[[], Any]], Any]
"""Carries out one simulation within the budget and counts it."""


class Steering(Generic[SnapshotT]):
    """What a task offers where its planning world can be steered. Snapshots are opaque, immutable and of that world only.

    Every ``propagate`` counts as one simulated action of the budget.

    Args:
        physics: What is steered.
        begin: Makes the first snapshot.
        charge: Keeps to the budget.
    """

    def __init__(self, physics: SupportsPropagation[SnapshotT], begin: Begin, charge: Charge) -> None:
        self._physics, self._begin, self._charge = physics, begin, charge

    def begin(self, state: State, pose: ArrayLike | None = None) -> SnapshotT:
        """A snapshot of a state at rest, from which to steer.

        Args:
            state: Any state; the arm may be parked.
            pose: Where a parked arm's fingertip begins ``(3,)``: x, y (m), yaw (rad); None: where it is parked.

        Raises:
            InputError: If the arm cannot have its fingertip there.
        """
        snapshot: SnapshotT = self._begin(state, None if pose is None else np.asarray(pose, dtype=np.float64))
        return snapshot

    def state_of(self, snapshot: SnapshotT) -> State:
        """What a snapshot holds, its speeds aside."""
        return self._physics.state_of(snapshot)

    def propagate(
        self,
        snapshot: SnapshotT,
        twist: ArrayLike,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[SnapshotT, Motion]:
        """Hold a fingertip twist ``(3,)`` (m/s, m/s, rad/s, shelf frame) for ``dt`` seconds; pure. See ``SupportsPropagation``.

        Raises:
            BudgetExceededError: If the budget is spent.
        """
        held = np.asarray(twist, dtype=np.float64)
        made: tuple[SnapshotT, Motion] = self._charge(
            lambda: self._physics.propagate(snapshot, held, dt, opening=opening, stop=stop)
        )
        return made
