"""A whole path in joints: in through the mouth, through the shelf, out again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from phframe.core import FloatArray, GripperPath, IntArray, Phase, PhaseRule, Unreachable
from phframe.motion.track import MOUTH_ZONE, Track, Tracker
from phframe.motion.waypoints import SPACING, Waypoints

OUTSIDE = -0.02
"""The fingertip has left the shelf when it is farther out than this (m)."""
WITHDRAWN = -0.04
"""With something in the hand, farther than this (m)."""
ENTERED_FROM = -0.03
"""Farther out than this (m), the fingertip need not follow a path before it goes in."""


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """Joints for a path's poses.

    Attributes:
        joints: ``(k, dof)``.
        poses: What they stand for, ``(k, 3)``: x, y, yaw.
        legs: The path's leg that leads to each ``(k,)``.
    """

    joints: FloatArray
    poses: FloatArray
    legs: IntArray


class Router:
    """Makes routes for one path.

    Args:
        path: The path.
        line: Its poses.
        tracker: Follows poses; its collisions know where everything stands.

    Attributes:
        gate: Row of the first pose behind the mouth zone.
        deepest: Row of the first of the deepest poses.
    """

    def __init__(self, path: GripperPath, line: Waypoints, tracker: Tracker) -> None:
        self._path, self._line, self._tracker = path, line, tracker
        deep = np.flatnonzero(line.poses[:, 0] >= MOUTH_ZONE)
        deepest = int(line.poses[:, 0].argmax())
        self.gate, self._last = (int(deep[0]), int(deep[-1])) if len(deep) else (deepest, deepest)
        self.deepest = deepest

    def pose(self, row: int) -> FloatArray:
        """A pose of the path ``(3,)``: x, y, yaw."""
        return np.asarray(self._line.poses[row])

    def permit(self, row: int) -> None:
        """Let happen what may at a pose of the path."""
        self._tracker.permit(self._rule(int(self._line.legs[row])), self._path.manipuland)

    def through(self, q: FloatArray, anchor: int, yaw: float, stride: int) -> Route | Unreachable:
        """The route that has given joint values at one of its poses.

        Args:
            q: The joint values ``(dof,)`` for that pose at the path's own yaw.
            anchor: Row of the pose.
            yaw: By how much the gripper is turned against the path (rad).
            stride: Every how many of the poses is looked at.
        """
        line = self._line.turned(yaw)
        self.permit(anchor)
        turned = self._tracker.turned(q, line.poses[anchor], yaw)
        if turned is None:
            return Unreachable(0.0, f"out of reach turned by {np.degrees(yaw):.0f} degrees", 0)
        begin = self._tracker.look(turned)
        if not begin.complete:
            return replace(self._unreachable(begin, anchor), where=float(line.lengths[min(anchor, self.gate)]))
        onwards = self._onwards(line, turned, anchor, stride)
        if isinstance(onwards, Unreachable):
            return onwards
        back = self._backwards(line, turned, anchor, stride)
        if isinstance(back, Unreachable):
            return back
        return Route(
            np.vstack([back.joints[::-1], turned[None], onwards.joints]),
            np.vstack([back.poses[::-1], line.poses[anchor][None], onwards.poses]),
            np.concatenate([back.legs[::-1], line.legs[anchor : anchor + 1], onwards.legs]),
        )

    def onwards(self, q: FloatArray, here: FloatArray) -> Route | Unreachable:
        """The route that begins with joint values ``(dof,)``, whose pose ``(3,)`` is close to the path's first."""
        route = self._onwards(self._line, q, 0, 1)
        if isinstance(route, Unreachable):
            return route
        return Route(
            np.vstack([q[None], route.joints]),
            np.vstack([here[None], route.poses]),
            np.concatenate([self._line.legs[:1], route.legs]),
        )

    def _onwards(self, line: Waypoints, q: FloatArray, begin: int, stride: int) -> Route | Unreachable:
        """From joint values at one of the poses, which is not among the route's, to the path's end."""
        tracks, rows = [], []
        for leg, stretch in self._stretches(begin + 1):
            looked_at = _thinned(stretch, stride)
            self._tracker.permit(self._rule(leg), self._path.manipuland)
            poses = line.poses[looked_at]
            if stretch[0] <= self._last:
                track = self._tracker.follow(q, poses, stride)
            else:
                track = self._tracker.leave(q, poses, float(line.poses[stretch[0] - 1, 0]), stride)
            tracks.append(track)
            rows.append(looked_at[: len(track.joints)])
            q = track.joints[-1] if len(track.joints) else q
            if not track.complete:
                if stretch[0] <= self._last or not self._is_out(track, leg, stride):
                    return self._unreachable(track, int(looked_at[len(track.joints)]))
                break
        return self._joined(tracks, rows, len(q))

    def _backwards(self, line: Waypoints, q: FloatArray, begin: int, stride: int) -> Route | Unreachable:
        """From joint values at one of the poses, which is not among the route's, to the path's beginning."""
        tracks, rows = [], []
        inside = np.arange(begin - 1, self.gate - 1, -1)
        for leg, stretch in groupby(inside.tolist(), lambda row: int(self._line.legs[row + 1])):
            looked_at = _thinned(np.array(list(stretch)), stride)
            self._tracker.permit(self._rule(leg), self._path.manipuland)
            track = self._tracker.follow(q, line.poses[looked_at], stride)
            if not track.complete:
                return self._unreachable(track, int(looked_at[len(track.joints)]))
            tracks.append(track)
            rows.append(looked_at)
            q = track.joints[-1]
        outside = np.arange(min(begin, self.gate))
        outside = outside[line.poses[outside, 0] >= ENTERED_FROM][::-stride]
        self._tracker.permit(self._rule(0), self._path.manipuland)
        entry = self._tracker.leave(q, line.poses[outside], float(line.poses[min(begin, self.gate), 0]), stride)
        tracks.append(entry)
        rows.append(outside[: len(entry.joints)])
        return self._joined(tracks, rows, len(q))

    def _stretches(self, begin: int) -> Iterator[tuple[int, IntArray]]:
        """Legs, and the rows of their poses from ``begin`` on: those in the shelf apart from those after it."""
        rows = range(begin, len(self._line.poses))
        for (leg, _), stretch in groupby(rows, lambda row: (int(self._line.legs[row]), row > self._last)):
            yield leg, np.array(list(stretch))

    def _rule(self, leg: int) -> PhaseRule:
        return self._path.rule(leg)

    def _is_out(self, track: Track, leg: int, stride: int) -> bool:
        """Whether a leg that ends early has led far enough out of the shelf, as far as one can tell."""
        enough = WITHDRAWN if self._path.phases[leg] is Phase.WITHDRAW else OUTSIDE
        enough += (stride - 1) * SPACING
        return bool(len(track.poses)) and float(track.poses[-1, 0]) <= enough

    def _unreachable(self, track: Track, row: int) -> Unreachable:
        x, y, yaw = self._line.poses[row].tolist()
        where = f"at x {x:.3f} m, y {y:.3f} m, yaw {np.degrees(yaw):.0f} degrees"
        return Unreachable(
            float(self._line.lengths[row]), f"{track.why} {where}", int(self._line.legs[row]), track.bodies
        )

    def _joined(self, tracks: list[Track], rows: list[IntArray], dof: int) -> Route:
        return Route(
            np.vstack([np.empty((0, dof)), *(track.joints for track in tracks)]),
            np.vstack([np.empty((0, 3)), *(track.poses for track in tracks)]),
            self._line.legs[np.concatenate([np.empty(0, dtype=np.int64), *rows])],
        )


def _thinned(rows: IntArray, stride: int) -> IntArray:
    """Every so many of the rows, the last one among them."""
    return rows if len(rows) < 2 else np.unique(np.append(rows[stride - 1 :: stride], rows[-1]))
