"""Cartesian paths in joint space: a gripper's whole path, in through the mouth, through the shelf and out again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from phframe.core import FloatArray, GripperPath, IntArray, Phase, Unreachable
from phframe.motion.cartesian_following import MOUTH_ZONE, CartesianFollower, FollowedPoses
from phframe.motion.cartesian_waypoints import CartesianWaypoints

OUTSIDE = -0.02
"""The fingertip has left the shelf when it is farther out than this (m)."""
WITHDRAWN = -0.04
"""With something in the hand, farther than this (m)."""
ENTERED_FROM = -0.03
"""Farther out than this (m), the fingertip need not follow a path before it goes in."""


@dataclass(frozen=True, slots=True, eq=False)
class JointPath:
    """Joints for a gripper path's poses.

    Attributes:
        joints: ``(k, dof)``.
        poses: What they stand for, ``(k, 3)``: x, y, yaw.
        legs: The gripper path's leg that leads to each ``(k,)``.
    """

    joints: FloatArray
    poses: FloatArray
    legs: IntArray


class CartesianPathFollower:
    """Finds joint paths for one gripper path.

    Args:
        path: The gripper path.
        line: Its poses.
        spacing: Between these (m).
        followers: By leg: follows poses in the collision context of that leg.

    Attributes:
        gate: Row of the first pose behind the mouth zone.
        deepest: Row of the first of the deepest poses.
    """

    def __init__(
        self,
        path: GripperPath,
        line: CartesianWaypoints,
        spacing: float,
        followers: Callable[[int], CartesianFollower],
    ) -> None:
        self._path, self._line, self._spacing, self._followers = path, line, spacing, followers
        deep = np.flatnonzero(line.poses[:, 0] >= MOUTH_ZONE)
        deepest = int(line.poses[:, 0].argmax())
        self.gate, self._last = (int(deep[0]), int(deep[-1])) if len(deep) else (deepest, deepest)
        self.deepest = deepest

    def pose(self, row: int) -> FloatArray:
        """A pose of the path ``(3,)``: x, y, yaw."""
        return np.asarray(self._line.poses[row])

    def follower(self, row: int) -> CartesianFollower:
        """What follows poses in the collision context of a pose of the path."""
        return self._followers(int(self._line.legs[row]))

    def through(self, q: FloatArray, anchor: int, yaw: float, stride: int) -> JointPath | Unreachable:
        """The joint path that has given joint values at one of its poses.

        Args:
            q: The joint values ``(dof,)`` for that pose at the path's own yaw.
            anchor: Row of the pose.
            yaw: By how much the gripper is turned against the path (rad).
            stride: Every how many of the poses is looked at.
        """
        line = self._line.turned(yaw)
        follower = self.follower(anchor)
        turned = follower.turned(q, line.poses[anchor], yaw)
        if turned is None:
            return Unreachable(0.0, f"out of reach turned by {np.degrees(yaw):.0f} degrees", 0)
        begin = follower.look(turned)
        if not begin.complete:
            return replace(self._unreachable(begin, anchor), where=float(line.lengths[min(anchor, self.gate)]))
        onwards = self._onwards(line, turned, anchor, stride)
        if isinstance(onwards, Unreachable):
            return onwards
        back = self._backwards(line, turned, anchor, stride)
        if isinstance(back, Unreachable):
            return back
        return JointPath(
            np.vstack([back.joints[::-1], turned[None], onwards.joints]),
            np.vstack([back.poses[::-1], line.poses[anchor][None], onwards.poses]),
            np.concatenate([back.legs[::-1], line.legs[anchor : anchor + 1], onwards.legs]),
        )

    def onwards(self, q: FloatArray, here: FloatArray) -> JointPath | Unreachable:
        """The joint path that begins with joint values ``(dof,)``, whose pose ``(3,)`` is close to the path's first."""
        onwards = self._onwards(self._line, q, 0, 1)
        if isinstance(onwards, Unreachable):
            return onwards
        return JointPath(
            np.vstack([q[None], onwards.joints]),
            np.vstack([here[None], onwards.poses]),
            np.concatenate([self._line.legs[:1], onwards.legs]),
        )

    def _onwards(self, line: CartesianWaypoints, q: FloatArray, begin: int, stride: int) -> JointPath | Unreachable:
        """From joint values at one of the poses, which is not among the result's, to the path's end."""
        parts, rows = [], []
        for leg, run in self._runs(begin + 1):
            looked_at = _thinned(run, stride)
            follower, poses = self._followers(leg), line.poses[looked_at]
            if run[0] <= self._last:
                part = follower.follow(q, poses, stride)
            else:
                part = follower.leave(q, poses, float(line.poses[run[0] - 1, 0]), stride)
            parts.append(part)
            rows.append(looked_at[: len(part.joints)])
            q = part.joints[-1] if len(part.joints) else q
            if not part.complete:
                if run[0] <= self._last or not self._is_out(part, leg, stride):
                    return self._unreachable(part, int(looked_at[len(part.joints)]))
                break
        return self._joined(parts, rows, len(q))

    def _backwards(self, line: CartesianWaypoints, q: FloatArray, begin: int, stride: int) -> JointPath | Unreachable:
        """From joint values at one of the poses, which is not among the result's, to the path's beginning."""
        parts, rows = [], []
        inside = np.arange(begin - 1, self.gate - 1, -1)
        for leg, run in groupby(inside.tolist(), lambda row: int(self._line.legs[row + 1])):
            looked_at = _thinned(np.array(list(run)), stride)
            part = self._followers(leg).follow(q, line.poses[looked_at], stride)
            if not part.complete:
                return self._unreachable(part, int(looked_at[len(part.joints)]))
            parts.append(part)
            rows.append(looked_at)
            q = part.joints[-1]
        outside = np.arange(min(begin, self.gate))
        outside = outside[line.poses[outside, 0] >= ENTERED_FROM][::-stride]
        entry = self._followers(0).leave(q, line.poses[outside], float(line.poses[min(begin, self.gate), 0]), stride)
        parts.append(entry)
        rows.append(outside[: len(entry.joints)])
        return self._joined(parts, rows, len(q))

    def _runs(self, begin: int) -> Iterator[tuple[int, IntArray]]:
        """Legs, and the rows of their poses from ``begin`` on: those in the shelf apart from those after it."""
        rows = range(begin, len(self._line.poses))
        for (leg, _), run in groupby(rows, lambda row: (int(self._line.legs[row]), row > self._last)):
            yield leg, np.array(list(run))

    def _is_out(self, part: FollowedPoses, leg: int, stride: int) -> bool:
        """Whether a leg that ends early has led far enough out of the shelf, as far as one can tell."""
        enough = WITHDRAWN if self._path.phases[leg] is Phase.WITHDRAW else OUTSIDE
        enough += (stride - 1) * self._spacing
        return bool(len(part.poses)) and float(part.poses[-1, 0]) <= enough

    def unreachable(self, row: int, why: str, bodies: tuple[str, ...] = ()) -> Unreachable:
        """That the path ends at one of its poses, and why."""
        where = f"{why} at {pose_text(self._line.poses[row])}"
        return Unreachable(float(self._line.lengths[row]), where, int(self._line.legs[row]), bodies)

    def _unreachable(self, part: FollowedPoses, row: int) -> Unreachable:
        return self.unreachable(row, part.why, part.bodies)

    def _joined(self, parts: list[FollowedPoses], rows: list[IntArray], dof: int) -> JointPath:
        return JointPath(
            np.vstack([np.empty((0, dof)), *(part.joints for part in parts)]),
            np.vstack([np.empty((0, 3)), *(part.poses for part in parts)]),
            self._line.legs[np.concatenate([np.empty(0, dtype=np.int64), *rows])],
        )


def pose_text(pose: FloatArray) -> str:
    """A pose of the gripper ``(3,)`` for people."""
    x, y, yaw = pose.tolist()
    return f"x {x:.3f} m, y {y:.3f} m, yaw {np.degrees(yaw):.0f} degrees"


def _thinned(rows: IntArray, stride: int) -> IntArray:
    """Every so many of the rows, the last one among them."""
    return rows if len(rows) < 2 else np.unique(np.append(rows[stride - 1 :: stride], rows[-1]))
