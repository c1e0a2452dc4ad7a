"""What keeps a kinodynamic search from going on from where a motion led."""

from __future__ import annotations

from phframe.core import Condition, State, Transition


def fault_of(before: State, made: Transition, *, at_rest: bool = True) -> str:
    """Why a search does not go on: the arm stalled or was stopped, something toppled or left the board, or still moves.

    Args:
        before: The state that the motion began with.
        made: The motion, and where it led.
        at_rest: Whether everything must be at rest afterwards.

    Returns:
        What was wrong; empty: nothing.
    """
    motion, after = made.motion, made.state
    if not motion.complete:
        return str(motion.stopped or f"stalled at {motion.largest_force:.0f} N")
    pairs = zip(before.conditions, after.conditions, strict=True)
    fallen = [new for old, new in pairs if new is not old and new is not Condition.UPRIGHT]
    if fallen:
        return f"something {fallen[0]}"
    return "not at rest" if at_rest and not motion.settled else ""
