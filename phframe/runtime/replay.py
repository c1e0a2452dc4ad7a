"""Replays actions for the moments in between, which nothing records while planning or executing."""

from __future__ import annotations

from collections.abc import Iterator

from phframe.core import Action, State, Watch
from phframe.runtime.planning_world import PlanningWorld

FRAME_PERIOD = 1.0 / 30.0
"""Of replayed frames (s)."""


def replay(
    world: PlanningWorld, before: State, action: Action, period: float = FRAME_PERIOD
) -> Iterator[tuple[float, State]]:
    """The world at moments of an action: seconds since it began, and the state.

    ``apply`` is pure, so this is what happened when the action was planned. An executed action goes on from where the
    world was; what an engine then still knew of its contacts, a replay does not know.

    Args:
        world: Where to replay.
        before: The state before the action.
        action: What was done.
        period: Seconds between moments.
    """
    frames: list[tuple[float, State]] = []
    world.apply(before, action, Watch(period, lambda time, state: frames.append((time, state))))
    yield from frames
