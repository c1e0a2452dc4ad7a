"""Joints that take the gripper along given poses and hit nothing on the way."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio

from phframe.core import ArmModel, BasePose, Contacts, FloatArray, PhaseRule, Scene, State
from phframe.motion.coal_ import CollisionModel, placement
from phframe.motion.follow import Follower

MOUTH_ZONE = 0.05
"""With less than this of the fingers in the shelf (m), the gripper may turn away from the path's yaw."""
TURNS = tuple(np.radians([0.0, -15.0, -30.0, -45.0, 15.0, 30.0, 45.0]).tolist())
"""How far it may do so on the way out (rad), tried in this order: none at first, all after ``MOUTH_ZONE`` of depth."""

SETTLING = 2
"""Improvements of a posture at each pose as the gripper turns on the spot."""
TURN_STEP = math.radians(5.0)
"""Between these poses (rad)."""


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Joints for poses, as far as they could be followed.

    Attributes:
        joints: ``(k, dof)``.
        poses: That they stand for ``(k, 3)``: x, y, yaw.
        why: What ended it; empty where all could be followed.
        bodies: What was in the way, if anything.
    """

    joints: FloatArray
    poses: FloatArray
    why: str = ""
    bodies: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether all poses could be followed."""
        return not self.why


class Tracker:
    """Follows poses of the gripper, level in its plane.

    Args:
        follower: Takes the joints from pose to pose.
        collisions: What must not be hit.
        base_pose: Of the arm.
        arm: The arm.
        scene: Whose objects may be touched or not.
    """

    def __init__(
        self, follower: Follower, collisions: CollisionModel, base_pose: BasePose, arm: ArmModel[Any], scene: Scene
    ) -> None:
        self._follower, self._collisions, self._scene = follower, collisions, scene
        self._base, self._height = placement(base_pose).inverse(), arm.shape.height
        self._names = [joint.name for joint in arm.joints]
        self._closed = np.array([joint.lower for joint in arm.fingers.joints])
        self._least = arm.shape.min_opening
        self._heights = np.array([item.shape.height for item in scene.objects])
        self._obstacles = np.empty((0, 4))

    def permit(self, rule: PhaseRule, manipuland: str | None) -> None:
        """Let the fingers be open and objects be touched as a rule has it."""
        self._collisions.open(self._closed + max(0.0, rule.opening - self._least) / 2.0)
        match rule.contacts:
            case Contacts.OBJECTS:
                touched = range(len(self._scene.objects))
            case Contacts.MANIPULAND if manipuland is not None:
                row = self._scene.index(manipuland)
                touched = range(row, row + 1)
            case _:
                touched = range(0)
        self._collisions.allow(touched)
        self._follower.posture.avoid(np.delete(self._obstacles, touched, axis=0))

    def place(self, state: State) -> None:
        """Let the objects stand where a state has them."""
        self._collisions.place(state)
        radii = np.where(state.on_board, self._scene.radii, -np.inf)
        tops = state.poses[:, 2] + self._heights / 2.0
        self._obstacles = np.column_stack([state.positions, radii, tops])

    def target(self, gripper: FloatArray) -> Any:
        """A pose seen from above ``(3,)`` as the follower wants it, in the frame of the base."""
        x, y, yaw = gripper.tolist()
        c, s = math.cos(yaw), math.sin(yaw)
        level = pinocchio.SE3(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), np.array([x, y, self._height]))
        return self._base.act(level)

    def follow(self, q: FloatArray, poses: Iterable[FloatArray], stride: int) -> Track:
        """From joint values ``(dof,)`` through poses; what may be touched is what the collisions allow."""
        joints: list[FloatArray] = []
        done: list[FloatArray] = []
        drift = np.zeros(len(q))
        for pose in poses:
            found = self._follower.next(q, drift, self.target(pose), pose, stride)
            if found is None:
                return _track(q, joints, done, self._out_of_reach(q))
            if why := self._in_the_way(found[0]):
                return _track(q, joints, done, *why)
            q, drift = found
            joints.append(q)
            done.append(pose)
        return _track(q, joints, done, "")

    def look(self, q: FloatArray) -> Track:
        """No poses from joint values ``(dof,)``; complete if nothing is in the way where they are."""
        return _track(q, [], [], *(self._in_the_way(q) or ("",)))

    def turned(self, q: FloatArray, pose: FloatArray, yaw: float) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose ``(3,)`` from those for the same, turned back by a yaw (rad), or None."""
        steps = math.ceil(abs(yaw) / TURN_STEP - 1e-9)
        poses = [pose - (0.0, 0.0, yaw * (1.0 - step / steps)) for step in range(1, steps + 1)]
        for each in poses:
            found = self._follower.improved(q, self.target(each), each, SETTLING)
            if found is None:
                return None
            q = found
        return q

    def leave(self, q: FloatArray, poses: FloatArray, begin: float, stride: int) -> Track:
        """From joint values outwards through poses ``(k, 3)``, turning away from their yaw where that helps.

        Args:
            q: Joint values ``(dof,)``.
            poses: Outwards, all in the mouth zone.
            begin: Depth at which ``q`` has the fingertip (m).
            stride: How many spacings of a path they are apart.
        """
        longest: Track | None = None
        for turn in TURNS:
            track = self.follow(q, _turned(poses, turn, begin), stride)
            if longest is None or len(track.joints) > len(longest.joints):
                longest = track
            if track.complete:
                break
        assert longest is not None
        return longest

    def _in_the_way(self, q: FloatArray) -> tuple[str, tuple[str, ...]] | None:
        """What is hit at joint values ``(dof,)``, in words and by name."""
        if self._collisions.is_free(q):
            return None
        link, body = self._collisions.collisions(q)[0]
        return f"{link} meets {body}", (body,)

    def _out_of_reach(self, q: FloatArray) -> str:
        at = [self._names[row] for row in self._follower.joints_at_limits(q)]
        return f"out of reach, with {' and '.join(at)} at the limit" if at else "out of reach in this posture"


def _turned(poses: FloatArray, turn: float, begin: float) -> FloatArray:
    """Poses with a turn that grows on the way out."""
    fractions = np.clip((begin - poses[:, 0]) / MOUTH_ZONE, 0.0, 1.0)
    return poses + np.column_stack([np.zeros((len(poses), 2)), turn * fractions])


def _track(
    q: FloatArray, joints: list[FloatArray], poses: list[FloatArray], why: str, bodies: tuple[str, ...] = ()
) -> Track:
    return Track(np.array(joints).reshape(-1, len(q)), np.array(poses).reshape(-1, 3), why, bodies)
