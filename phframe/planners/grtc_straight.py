"""GRTC-Heuristic with straight pushes: the baseline that the paper compares with (after Papallas and Dogar 2020)."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from phframe.core import FloatArray, Plan, Planner, Task
from phframe.pushing import GrtcSearch, Obstruction, StraightPushOptions


class GRTCStraightOptions(StraightPushOptions):
    """Figures of GRTC with straight pushes.

    Attributes:
        grid: Spacing of the places that are considered (m).
        near: Places no farther than this from where the object stands come first (m).
    """

    grid: Annotated[float, Field(ge=0.005, le=0.5)] = 0.03
    near: Annotated[float, Field(gt=0.0, le=1.0)] = 0.2


class GRTCStraight(Planner[GRTCStraightOptions]):
    """Drives straight at the target in simulation, and pushes the first object that it meets straight to a free place."""

    options_type = GRTCStraightOptions

    def search(self, task: Task) -> Plan:
        """Greedy: one push per configuration, to the first place of a random order that it gets to."""
        grtc = GrtcSearch(task, self.options)
        return grtc.run(lambda met: self._to_free_place(task, grtc, met))

    def _to_free_place(self, task: Task, grtc: GrtcSearch, met: Obstruction) -> int | str:
        """Push the blocker to the first place that it gets to, each tried once; why not, where there is none."""
        row, before = task.scene.index(met.blocker), len(grtc.search.tree)
        places = grtc.pusher.free_places(met.state, row, met.drive, self.options.grid)
        for place in in_random_order(places, met.state.positions[row], self.options.near, task.rng):
            pushed = grtc.push(met, met.blocker, place)
            if isinstance(pushed, int):
                return pushed
            if grtc.spent:
                break
        tried = len(grtc.search.tree) - before
        return f"{met.blocker} gets to none of {len(places)} free places; {tried} of the pushes there were simulated"


def in_random_order(places: FloatArray, position: FloatArray, near: float, rng: np.random.Generator) -> FloatArray:
    """Places ``(k, 2)`` in random order, those no farther than ``near`` (m) from a position ``(2,)`` first."""
    shuffled = places[rng.permutation(len(places))]
    far = np.linalg.norm(shuffled - position, axis=1) > near
    return np.concatenate([shuffled[~far], shuffled[far]])
