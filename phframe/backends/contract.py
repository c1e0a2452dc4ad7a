"""What every backend holds to in the same way: the figures of the Physics contract, stop conditions, lists of contacts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from phframe.core import Contact, GripperTrajectory, Stop, StopCause, StopReason

START_POSITION, START_ANGLE = 2e-3, 1e-2
"""Distance (m) and angle (rad) from the arm within which a trajectory must begin."""
TOP_SPEED = 20.0
"""Speed (m/s) above which a body is taken for a diverged simulation."""

Touch = tuple[float, str, str, bool]
"""Time since the motion began (s), part of the arm, name of what it met, whether that is a wall."""


def touch_reason(stop: Stop, touches: Iterable[Touch]) -> StopReason | None:
    """Why contacts of the arm end a motion, if they do."""
    for _, _, name, wall in touches:
        if (wall and stop.wall) or name in stop.bodies:
            return StopReason(StopCause.WALL if wall else StopCause.CONTACT, name)
    return None


def force_reason(stop: Stop | None, force: float) -> StopReason | None:
    """Why a force (N) on the arm ends a motion, if it does."""
    if stop is None or stop.force is None or force <= stop.force:
        return None
    return StopReason(StopCause.FORCE, force=force)


def first_contacts(
    touches: Iterable[Touch], trajectory: GripperTrajectory, *, walls: bool, delay: float = 0.0
) -> Iterator[Contact]:
    """The first contact of each part of the arm with each body in each phase, in order of time.

    Args:
        touches: All that were noted, in order of time.
        trajectory: Whose phases they fall into.
        walls: Those with walls rather than with objects.
        delay: How long after it began a contact is noted (s).
    """
    seen = set()
    for time, part, body, _ in (touch for touch in touches if touch[3] is walls):
        phase = trajectory.phase_at(time - delay)
        if (part, body, phase) not in seen:
            seen.add((part, body, phase))
            yield Contact(time, body, phase, part)
