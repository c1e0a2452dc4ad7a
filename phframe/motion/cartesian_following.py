"""Collision-checked Cartesian path following: joints that take the gripper along given poses and touch nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio

from phframe.core import BasePose, FloatArray
from phframe.motion.coal_ import CollisionChecker
from phframe.motion.differential_ik import DifferentialIK
from phframe.motion.pinocchio_ import se3

MOUTH_ZONE = 0.05
"""With less than this of the fingers in the shelf (m), the gripper may turn away from the path's yaw."""
EXIT_YAWS = tuple(np.radians([0.0, -15.0, -30.0, -45.0, 15.0, 30.0, 45.0]).tolist())
"""How far it may do so on the way out (rad), tried in this order: none at first, all after ``MOUTH_ZONE`` of depth."""
IMPROVEMENTS = 2
"""Of the null-space objective at each pose as the gripper turns on the spot."""
YAW_STEP = math.radians(5.0)
"""Most that the gripper turns on the spot between two poses (rad)."""


@dataclass(frozen=True, slots=True, eq=False)
class FollowedPoses:
    """Joints for poses, as far as they could be followed.

    Attributes:
        joints: ``(k, dof)``.
        poses: That they stand for ``(k, 3)``: x, y, yaw.
        why: What ended it; empty where all could be followed.
        bodies: What was collided with, if anything.
    """

    joints: FloatArray
    poses: FloatArray
    why: str = ""
    bodies: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether all poses could be followed."""
        return not self.why


class CartesianFollower:
    """Follows poses of the gripper, level in its plane, in one collision context.

    Args:
        ik: Takes the joints from pose to pose.
        checker: Says what is collision-free, in that context.
        base_pose: Of the arm.
        height: Of the gripper plane above the board (m).
        names: Of the joints.
    """

    def __init__(
        self, ik: DifferentialIK, checker: CollisionChecker, base_pose: BasePose, height: float, names: Sequence[str]
    ) -> None:
        self._ik, self._checker, self._names = ik, checker, names
        self._base, self._height = se3(base_pose.pose).inverse(), height

    def target(self, gripper: FloatArray) -> Any:
        """A pose seen from above ``(3,)`` as the kinematics want it, in the frame of the base."""
        x, y, yaw = gripper.tolist()
        c, s = math.cos(yaw), math.sin(yaw)
        level = pinocchio.SE3(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), np.array([x, y, self._height]))
        return self._base.act(level)

    def follow(self, q: FloatArray, poses: Iterable[FloatArray], stride: int) -> FollowedPoses:
        """From joint values ``(dof,)`` through poses ``(3,)``, each so many waypoints from the last."""
        joints: list[FloatArray] = []
        done: list[FloatArray] = []
        null_motion = np.zeros(len(q))
        for pose in poses:
            found = self._ik.step(q, null_motion, self.target(pose), pose, stride)
            if found is None:
                return _followed(q, joints, done, self._out_of_reach(q))
            if why := self._collision(found[0]):
                return _followed(q, joints, done, *why)
            q, null_motion = found
            joints.append(q)
            done.append(pose)
        return _followed(q, joints, done, "")

    def look(self, q: FloatArray) -> FollowedPoses:
        """No poses from joint values ``(dof,)``; complete if those are collision-free."""
        return _followed(q, [], [], *(self._collision(q) or ("",)))

    def improved(self, q: FloatArray, pose: FloatArray, times: int) -> FloatArray | None:
        """Joint values after so many improvements of the objective at one pose ``(3,)``, or None where it is lost."""
        return self._ik.improved(q, self.target(pose), pose, times)

    def turned(self, q: FloatArray, pose: FloatArray, yaw: float) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose ``(3,)`` from those for the same, turned back by a yaw (rad), or None."""
        steps = math.ceil(abs(yaw) / YAW_STEP - 1e-9)
        for step in range(1, steps + 1):
            found = self.improved(q, pose - (0.0, 0.0, yaw * (1.0 - step / steps)), IMPROVEMENTS)
            if found is None:
                return None
            q = found
        return q

    def leave(self, q: FloatArray, poses: FloatArray, begin: float, stride: int) -> FollowedPoses:
        """From joint values outwards through poses ``(k, 3)``, turning away from their yaw where that helps.

        Args:
            q: Joint values ``(dof,)``.
            poses: Outwards, all in the mouth zone.
            begin: Depth at which ``q`` has the fingertip (m).
            stride: How many waypoints they are apart.
        """
        longest = self.follow(q, poses, stride)
        for yaw in EXIT_YAWS[1:]:
            if longest.complete:
                break
            other = self.follow(q, _turned(poses, yaw, begin), stride)
            longest = other if len(other.joints) > len(longest.joints) else longest
        return longest

    def _collision(self, q: FloatArray) -> tuple[str, tuple[str, ...]] | None:
        """What collides at joint values ``(dof,)``, in words and by name."""
        if self._checker.is_free(q):
            return None
        link, body = self._checker.collisions(q)[0]
        return f"{link} meets {body}", (body,)

    def _out_of_reach(self, q: FloatArray) -> str:
        at = [self._names[row] for row in self._ik.joints_at_limits(q)]
        return f"out of reach, with {' and '.join(at)} at the limit" if at else "out of reach in this configuration"


def _turned(poses: FloatArray, yaw: float, begin: float) -> FloatArray:
    """Poses with a yaw added that grows on the way out."""
    fractions = np.clip((begin - poses[:, 0]) / MOUTH_ZONE, 0.0, 1.0)
    return poses + np.column_stack([np.zeros((len(poses), 2)), yaw * fractions])


def _followed(
    q: FloatArray, joints: list[FloatArray], poses: list[FloatArray], why: str, bodies: tuple[str, ...] = ()
) -> FollowedPoses:
    return FollowedPoses(np.array(joints).reshape(-1, len(q)), np.array(poses).reshape(-1, 3), why, bodies)
