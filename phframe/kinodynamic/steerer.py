"""Searching for controls that steer the gripper of one task into a region."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.core import FloatArray, State, Steering
from phframe.kinodynamic.ompl_ import ControlSearch, search_controls
from phframe.kinodynamic.region import Region
from phframe.kinodynamic.steered_tree import Controls, Room, SteeredTree


@dataclass(frozen=True, slots=True, eq=False)
class SteeredLeg:
    """What a search for controls came to: the controls that reach the region, or those that came nearest to it.

    Attributes:
        tree: All that was tried.
        end: Index of its node where the controls lead.
        distance: Of that node from the middle of the region (m).
        reached: Whether it is in the region.
    """

    tree: SteeredTree
    end: int
    distance: float
    reached: bool

    @property
    def snapshot(self) -> Any:
        """The world where it ends."""
        return self.tree[self.end].snapshot

    @property
    def state(self) -> State:
        """The same, its speeds aside."""
        return self.tree[self.end].state

    @property
    def start(self) -> FloatArray:
        """Pose of the fingertip where it begins ``(3,)``."""
        return self.tree[0].pose

    @property
    def twists(self) -> FloatArray:
        """The controls ``(k, 3)``; none where the region was reached from the beginning."""
        return self.tree.twists(self.end)


class Steerer:
    """Steers the gripper of one task.

    Args:
        steering: Of the task.
        controls: What to choose from.
        room: Where the fingertip may be.
        search: How controls are searched.
        rng: The only source of randomness.
    """

    def __init__(
        self, steering: Steering[Any], controls: Controls, room: Room, search: ControlSearch, rng: np.random.Generator
    ) -> None:
        self.controls, self.room = controls, room
        self._steering, self._search, self._rng = steering, search, rng

    def begin(self, state: State) -> Any:
        """The snapshot of a state at rest; a parked arm begins where it is parked."""
        return self._steering.begin(state)

    def leg(self, snapshot: Any, region: Region, *, opening: float, bias: float, most: int) -> SteeredLeg:
        """Steer from a snapshot into a region, or as near to it as so many controls bring.

        Args:
            snapshot: Where to start.
            region: Where to get.
            opening: Distance between the fingers (m).
            bias: How often the search aims at the region.
            most: How many controls are tried at most.

        Raises:
            BudgetExceededError: If the task's budget is spent.
        """
        tree = SteeredTree(self._steering, snapshot, self.controls, self.room, opening)
        end = search_controls(
            tree, region, self.controls, search=self._search, goal_bias=bias, most=most, rng=self._rng
        )
        distances = [region.distance(region.coordinates(tree[row].state)) for row in range(len(tree))]
        nearest = int(np.argmin(distances)) if end is None else end
        return SteeredLeg(tree, nearest, distances[nearest], end is not None)
