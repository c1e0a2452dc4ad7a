"""GRTC-Heuristic with straight pushes: the baseline that the paper compares with (after Papallas and Dogar 2020)."""

from __future__ import annotations

from phframe.core import Plan, Planner, Task
from phframe.pushing.grtc import GrtcSearch
from phframe.pushing.straight_drive import StraightDrive
from phframe.pushing.straight_push import StraightPushOptions


class GRTCStraight(Planner[StraightPushOptions]):
    """Drives straight at the target in simulation, and pushes the first object that it meets straight to a free place."""

    options_type = StraightPushOptions

    def search(self, task: Task) -> Plan:
        """Greedy: one push per configuration, to the first place of a random order that it gets to."""
        grtc = GrtcSearch(task, self.options)
        return grtc.run(lambda node, drive, blocker: self._to_free_place(task, grtc, node, drive, blocker))

    def _to_free_place(self, task: Task, grtc: GrtcSearch, node: int, drive: StraightDrive, blocker: str) -> int | str:
        """Push the blocker to the first place that it gets to, each tried once; why not, where there is none."""
        state, row, before = grtc.search.state(node), task.scene.index(blocker), len(grtc.search.tree)
        places = grtc.pusher.free_places(state, row, drive)
        for place in grtc.pusher.in_order(places, state.positions[row], task.rng):
            pushed = grtc.push(node, drive, blocker, place, f"the straight drive meets {blocker} first")
            if isinstance(pushed, int):
                return pushed
            if grtc.spent:
                break
        tried = len(grtc.search.tree) - before
        return f"{blocker} gets to none of {len(places)} free places; {tried} of the pushes there were simulated"
