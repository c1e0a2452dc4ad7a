"""A push that stalls, cut short of where it does."""

from __future__ import annotations

from dataclasses import replace

from phframe.core import Motion, time_path
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import PushingOptions
from phframe.pushing.push_search import Proposal
from phframe.pushing.sweep import Sweep, push_action

SHORT_OF_STALL = 0.01
"""How far before the place where it stalls a push ends (m)."""


def cut_short(push: Proposal, stalled: Motion, options: PushingOptions) -> Proposal | None:
    """The push that ends, or no longer goes in, a little before it stalls; None where that would move nothing.

    Args:
        push: What was simulated.
        stalled: What it came to.
        options: The planner's.
    """
    decision, action = push
    if decision.sweep is None or decision.corridor is None:
        return None
    sweep = _shorter(decision.sweep, _driven(push, stalled))
    if sweep is None:
        return None
    closed = action.path.rule(0).opening
    shorter = push_action(decision.corridor, sweep, decision.chosen, closed, options)
    deviations = dict.fromkeys((*decision.deviations, Deviation.CUT_SHORT))
    return replace(decision, sweep=sweep, deviations=tuple(deviations)), shorter


def _driven(push: Proposal, stalled: Motion) -> tuple[float, float]:
    """How much was driven of the way in and of the way across, as fractions."""
    path = push[1].path
    _, inserted, swept, _ = time_path(path, path.rule(0).opening, 1.0).times.tolist()
    across = (stalled.followed - inserted) / (swept - inserted)
    return min(stalled.followed / inserted, 1.0), min(max(across, 0.0), 1.0)


def _shorter(sweep: Sweep, driven: tuple[float, float]) -> Sweep | None:
    """The way out from anywhere on the way across is as long as its place between lane and end says."""
    inserted, across = driven
    if inserted < 1.0:
        entry = inserted * sweep.entry - SHORT_OF_STALL
        tip = sweep.waypoints[0] + (sweep.waypoints[1] - sweep.waypoints[0]) * (entry / sweep.entry)
        moved = float(tip[1]) - sweep.lane
        out = sweep.exit - (sweep.entry - entry)
        return (
            replace(sweep, depth=float(tip[0]), lane=float(tip[1]), end=sweep.end + moved, entry=entry, exit=out)
            if entry > 0.0 and out > 0.0
            else None
        )
    width = abs(sweep.end - sweep.lane)
    kept = across * width - SHORT_OF_STALL
    if kept < SHORT_OF_STALL:
        return None
    fraction = kept / width
    end = sweep.lane + sweep.direction * kept
    return replace(sweep, end=end, exit=sweep.entry + fraction * (sweep.exit - sweep.entry))
