"""A push that stalls, cut short of where it does."""

from __future__ import annotations

import math
from dataclasses import replace

from phframe.core import FloatArray, Transition
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import PushingOptions
from phframe.pushing.push_search import Proposal
from phframe.pushing.sweep import Sweep, push_action

SHORT_OF_STALL = 0.01
"""How far before the place where it stalls a push ends (m)."""


def cut_short(push: Proposal, stalled: Transition, options: PushingOptions) -> Proposal | None:
    """The sweep that ends a little before it stalls on its way across.

    From a stall the arm draws straight back along its axis (``PlanningWorld.apply``), so that where it stands then tells how
    far across it was, whatever engine drove it, from wherever it approached.

    Args:
        push: What was simulated.
        stalled: What it came to.
        options: The planner's.

    Returns:
        None where it stalls on its way in, or so early that hardly anything would move.
    """
    decision, action = push
    if decision.sweep is None or decision.corridor is None or stalled.state.arm is None:
        return None
    sweep = _shorter(decision.sweep, decision.corridor.to_local(stalled.state.arm.gripper[:2]))
    if sweep is None:
        return None
    closed = action.path.rule(0).opening
    shorter = push_action(decision.corridor, sweep, decision.chosen, closed, options)
    deviations = dict.fromkeys((*decision.deviations, Deviation.CUT_SHORT))
    return replace(decision, sweep=sweep, deviations=tuple(deviations)), shorter


def _shorter(sweep: Sweep, drawn_back: FloatArray) -> Sweep | None:
    """The way out from anywhere on the way across is as long as its place between lane and end says.

    Args:
        sweep: The one that stalls.
        drawn_back: Where the fingertip stands ``(2,)`` after it drew back, in the corridor frame (m).
    """
    x, y = drawn_back.tolist()
    stalled = y + (sweep.depth - x) * math.tan(sweep.tilt)
    kept = sweep.direction * (stalled - sweep.lane) - SHORT_OF_STALL
    if kept < SHORT_OF_STALL:
        return None
    fraction = kept / abs(sweep.end - sweep.lane)
    end = sweep.lane + sweep.direction * kept
    return replace(sweep, end=end, exit=sweep.entry + fraction * (sweep.exit - sweep.entry))
