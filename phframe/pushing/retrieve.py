"""The paper's goal: the target out of the shelf and in the hand; and how far it got: corridor empty, grasp pose reached."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from phframe.core import (
    ActionKind,
    Assessment,
    Attempt,
    Condition,
    Contacts,
    Goal,
    JointTrajectory,
    Options,
    Phase,
    Scene,
    State,
    Status,
)
from phframe.pushing.corridor import Corridor, find_corridor


class RetrieveOptions(Options):
    """What to retrieve, and by which measure a corridor counts as empty.

    Attributes:
        target: Id of the object to take out; None: the scene's target.
        half_width: Of the corridor that is empty when the target counts as cleared, w (m); the paper's.
    """

    target: str | None = None
    half_width: Annotated[float, Field(gt=0.0, le=1.0)] = 0.12


class Retrieve(Goal[RetrieveOptions]):
    """Take the target out of the shelf: met when all of it is before the mouth, and in the hand."""

    options_type = RetrieveOptions

    def scene(self, scene: Scene) -> Scene:
        """The scene with the object that is to be retrieved as its target.

        Raises:
            SceneError: If there is no such object.
        """
        wanted = self.options.target
        return scene if wanted in (None, scene.target) else replace(scene, target=wanted)

    def grasped(self, scene: Scene) -> str:
        """The object that is to be retrieved."""
        return self.scene(scene).target

    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        """How far it got.

        The goal is lost once the target lies or is gone, or is held without having come out, or something is held that
        the last action was not to hold.
        """
        scene = self.scene(scene)
        row, target = scene.target_index, scene.target
        if state.held == target and state.positions[row, 0] + scene.radii[row] <= 0.0:
            return Assessment(Status.RETRIEVED)
        status, reason = self._as_it_stands(scene, state)
        if last is not None and last.action.kind is ActionKind.GRASP and last.action.path.manipuland == target:
            status, reason = self._after_grasp(scene, state, last)
        if state.conditions[row] is not Condition.UPRIGHT:
            return Assessment(Status.FAILED, f"the target {target!r} is {state.conditions[row]}", lost=True)
        if state.held not in (None, target):
            meant = last is not None and last.action.path.manipuland == state.held
            return Assessment(Status.FAILED, f"{state.held} is in the hand instead of {target}", lost=not meant)
        return Assessment(status, reason, lost=state.held is not None)

    def _as_it_stands(self, scene: Scene, state: State) -> tuple[Status, str]:
        """How far it got without a grasp."""
        if is_cleared(scene, state, self.options.half_width):
            return Status.CLEARED, "the corridor is empty, and the target was not grasped"
        return Status.FAILED, "the corridor is not empty"

    def _after_grasp(self, scene: Scene, state: State, last: Attempt) -> tuple[Status, str]:
        """What a reach, grasp and withdrawal that did not bring the target out came to."""
        at_pose = _at_grasp_pose(last)
        if at_pose and not _touched_on_the_way(last):
            drawn = "the target was not drawn out" if state.held == scene.target else "the target was not held"
            return Status.REACHED, f"{drawn}{_stall(last)}"
        short = "the reach touched what it must not" if at_pose else f"the reach stalled{_stall(last)}"
        return self._as_it_stands(scene, state)[0], short


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


def _at_grasp_pose(last: Attempt) -> bool:
    """Whether the gripper got to the end of its reach."""
    if last.motion.complete:
        return True
    driven = last.trajectory
    if driven is None:
        return False
    gripper = driven.gripper if isinstance(driven, JointTrajectory) else driven
    return last.motion.followed >= float(gripper.times[gripper.phases.index(Phase.GRASP)])


def _stall(last: Attempt) -> str:
    """By which force the arm was stopped, if by any."""
    return f": the arm stalled at {last.motion.largest_force:.0f} N" if last.motion.stalled else ""


def _touched_on_the_way(last: Attempt) -> bool:
    """Whether the arm touched a wall while it reached, or an object that the path does not allow."""
    path, motion = last.action.path, last.motion
    rules = [path.rule(leg) for leg, phase in enumerate(path.phases) if phase is Phase.REACH]
    anything = any(rule.contacts is Contacts.OBJECTS for rule in rules)
    allowed = {path.manipuland} if any(rule.contacts is Contacts.MANIPULAND for rule in rules) else set()
    objects = any(c.phase is Phase.REACH and not anything and c.body not in allowed for c in motion.contacts)
    return objects or any(contact.phase is Phase.REACH for contact in motion.wall_contacts)
