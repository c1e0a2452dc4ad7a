"""How far it got: when a corridor is empty, a grasp pose reached, a target retrieved."""

from __future__ import annotations

from phframe.core import Condition, Contacts, Corridor, GripperPath, Motion, Phase, Scene, State, Status
from phframe.pushing.corridor import find_corridor


def is_cleared(scene: Scene, state: State, half_width: float) -> bool:
    """Whether the corridor to the target, where it is now, is empty.

    Args:
        scene: The scene.
        state: The world at rest.
        half_width: Of the corridor (m).
    """
    row = scene.target_index
    if state.conditions[row] is not Condition.UPRIGHT:
        return False
    corridor = find_corridor(state.positions[row], scene.shelf, half_width)
    if not isinstance(corridor, Corridor):
        return False
    inside = corridor.contains(state.positions) & state.on_board
    inside[row] = False
    return not inside.any()


def grasp_outcome(
    scene: Scene, state: State, path: GripperPath, motion: Motion, *, at_pose: bool, half_width: float
) -> tuple[Status, str]:
    """What a reach, grasp and withdrawal came to, and why not to more.

    Args:
        scene: The scene.
        state: The world after it.
        path: Of the gripper.
        motion: What happened on the way.
        at_pose: Whether the gripper got to the end of its reach.
        half_width: Of the corridor (m).
    """
    row = scene.target_index
    if state.held == scene.target and state.positions[row, 0] + scene.radii[row] <= 0.0:
        return Status.RETRIEVED, ""
    if at_pose and not _touched_on_the_way(scene, path, motion):
        drawn = "the target was not drawn out" if state.held == scene.target else "the target was not held"
        return Status.REACHED, drawn
    short = "the reach touched what it must not" if at_pose else "the reach stalled"
    return (Status.CLEARED if is_cleared(scene, state, half_width) else Status.FAILED), short


def _touched_on_the_way(scene: Scene, path: GripperPath, motion: Motion) -> bool:
    """Whether the arm touched a wall while it reached, or an object that the path does not allow."""
    rule = path.rules.get(Phase.REACH)
    allowed = {scene.target} if rule is not None and rule.contacts is Contacts.TARGET else set()
    anything = rule is not None and rule.contacts is Contacts.OBJECTS
    objects = any(c.phase is Phase.REACH and not anything and c.body not in allowed for c in motion.contacts)
    return objects or any(contact.phase is Phase.REACH for contact in motion.wall_contacts)
