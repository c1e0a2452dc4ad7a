"""Puts what a run did into a Motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from phframe.backends.pymunk_.world import ShelfSpace
from phframe.core import Contact, GripperTrajectory, Motion, StopReason


class Run(Protocol):
    """What a run knows at its end: force (N), lag (m), and how it went."""

    force: float
    lag: float
    stalled: bool
    settled: bool
    cause: StopReason | None


def motion_of(run: Run, world: ShelfSpace, trajectory: GripperTrajectory, step: float, followed: int) -> Motion:
    """The motion of a run that has ended.

    Args:
        run: How it went.
        world: As it is now.
        trajectory: What was followed.
        step: Time step (s).
        followed: How many steps of it were driven.
    """
    contacts = tuple(_contacts(world, trajectory, step, walls=False))
    return Motion(
        duration=world.tick * step,
        contacts=contacts,
        wall_contacts=tuple(_contacts(world, trajectory, step, walls=True)),
        largest_force=run.force,
        stalled=run.stalled,
        stopped=run.cause,
        tracking_error=run.lag,
        settled=run.settled,
        followed=followed * step,
    )


def _contacts(world: ShelfSpace, trajectory: GripperTrajectory, step: float, *, walls: bool) -> Iterator[Contact]:
    """The first contact of each part with each body in each phase."""
    seen = set()
    for tick, part, body, wall in world.touched:
        phase = trajectory.phase_at(tick * step)
        if wall is walls and (part, body, phase) not in seen:
            seen.add((part, body, phase))
            yield Contact(tick * step, body, phase, part)
