"""What a push or a grasp did that it should not: toppled or spilled something, stalled, touched a wall, moved the target."""

from __future__ import annotations

from collections.abc import Iterator

from phframe.core import Action, Condition, Scene, State, Transition

MOVED_TARGET = 0.02
"""How far a push may displace the target (m)."""


def displacement_allowed(scene: Scene, action: Action) -> float | None:
    """How far an action may displace the target (m); None: any distance, since it means to move it."""
    return None if scene.target in action.moves else MOVED_TARGET


def harm(scene: Scene, before: State, made: Transition, moved_target: float | None = MOVED_TARGET) -> str:
    """The harm that an action did, in words; empty: none. What becomes of the target in the hand is none.

    Args:
        scene: The scene, its target the object that is to be retrieved.
        before: The world before the action.
        made: What the action made of it.
        moved_target: How far the target may be displaced (m); None: any distance.
    """
    return next(_harms(scene, before, made, moved_target), "")


def _harms(scene: Scene, before: State, made: Transition, moved_target: float | None) -> Iterator[str]:
    motion, after, row = made.motion, made.state, scene.target_index
    if motion.wall_contacts:
        yield f"the arm touches the {motion.wall_contacts[0].body}"
    if motion.stopped is not None:
        yield str(motion.stopped)
    if motion.stalled:
        yield f"the arm stalls at {motion.largest_force:.0f} N"
    for name, was, now in zip(scene.ids, before.conditions, after.conditions, strict=True):
        if was is Condition.UPRIGHT and now is not Condition.UPRIGHT:
            yield f"{name} is {now}"
    if moved_target is not None and after.held is None and after.displacement(before)[row] > moved_target:
        yield f"the target moves by more than {1000 * moved_target:.0f} mm"
