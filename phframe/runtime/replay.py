"""Replays steps for the moments in between, which nothing records while planning or executing."""

from __future__ import annotations

from phframe.core import State, Trajectory, Watch
from phframe.runtime.world import World

FRAME_PERIOD = 1.0 / 30.0
"""Of replayed frames (s)."""


def replay(
    world: World, before: State, trajectory: Trajectory, period: float = FRAME_PERIOD
) -> list[tuple[float, State]]:
    """The world at moments of a step: seconds since it began, and the state.

    What was driven is driven again, from the state before. What was executed went on from where the world was; what an
    engine then still knew of its contacts, a replay does not know.

    Args:
        world: Where to replay; like the one that the step was carried out in.
        before: The state before the step.
        trajectory: What was driven.
        period: Seconds between moments.
    """
    frames: list[tuple[float, State]] = []
    world.physics.restore(before)
    world.follow(trajectory, Watch(period, lambda time, state: frames.append((time, state))))
    return frames
