"""A whole path in joints: in through the mouth, through the shelf, out again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from phframe.arms.coal_ import CollisionModel
from phframe.arms.track import MOUTH_ZONE, Track, Tracker
from phframe.arms.waypoints import Waypoints
from phframe.core import Contacts, FloatArray, GripperPath, IntArray, Phase, Scene, Unreachable

OUTSIDE = -0.02
"""The fingertip has left the shelf when it is farther out than this (m)."""
WITHDRAWN = -0.05
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
    """Makes routes for one path among objects that stand where the collisions have them.

    Args:
        path: The path.
        line: Its poses.
        scene: Whose objects may be touched or not.
        tracker: Follows poses.
        collisions: What must not be hit.
    """

    def __init__(
        self, path: GripperPath, line: Waypoints, scene: Scene, tracker: Tracker, collisions: CollisionModel
    ) -> None:
        self._path, self._line, self._scene = path, line, scene
        self._tracker, self._collisions = tracker, collisions
        deep = np.flatnonzero(line.poses[:, 0] >= MOUTH_ZONE)
        deepest = int(line.poses[:, 0].argmax())
        self.gate, self._last = (int(deep[0]), int(deep[-1])) if len(deep) else (deepest, deepest)

    @property
    def entrance(self) -> FloatArray:
        """The pose ``(3,)`` at the gate."""
        return self._line.poses[self.gate]

    def through(self, q: FloatArray) -> Route | Unreachable:
        """The route that has joint values ``(dof,)`` at the gate, the first pose behind the mouth zone."""
        gate = self._line.poses[self.gate]
        inner = self._onwards(q, self.gate)
        if isinstance(inner, Unreachable):
            return inner
        before = np.arange(self.gate - 1, -1, -1)
        before = before[self._line.poses[before, 0] >= ENTERED_FROM]
        self._permit(int(self._line.legs[self.gate]))
        entry = self._tracker.leave(q, self._line.poses[before], float(gate[0]))
        return Route(
            np.vstack([entry.joints[::-1], q[None], inner.joints]),
            np.vstack([entry.poses[::-1], gate[None], inner.poses]),
            np.concatenate([np.full(len(entry.joints) + 1, self._line.legs[self.gate]), inner.legs]),
        )

    def onwards(self, q: FloatArray) -> Route | Unreachable:
        """The route that begins with joint values ``(dof,)`` at, or close to, the path's first pose."""
        route = self._onwards(q, 0)
        if isinstance(route, Unreachable):
            return route
        return Route(
            np.vstack([q[None], route.joints]),
            np.vstack([self._line.poses[:1], route.poses]),
            np.concatenate([self._line.legs[:1], route.legs]),
        )

    def _onwards(self, q: FloatArray, begin: int) -> Route | Unreachable:
        """From joint values at one of the poses, which is not among the route's, to the path's end."""
        tracks, rows = [], []
        for leg, stretch in self._stretches(begin + 1):
            track = self._along(q, leg, stretch)
            tracks.append(track)
            rows.append(stretch[: len(track.joints)])
            q = track.joints[-1] if len(track.joints) else q
            if not track.complete:
                if not self._is_out(track, leg):
                    return self._unreachable(track, int(stretch[len(track.joints)]))
                break
        return self._joined(tracks, rows, len(q))

    def _stretches(self, begin: int) -> Iterator[tuple[int, IntArray]]:
        """Legs, and the rows of their poses from ``begin`` on: those in the shelf apart from those after it."""
        rows = range(begin, len(self._line.poses))
        for (leg, _), stretch in groupby(rows, lambda row: (int(self._line.legs[row]), row > self._last)):
            yield leg, np.array(list(stretch))

    def _along(self, q: FloatArray, leg: int, rows: IntArray) -> Track:
        self._permit(leg)
        poses = self._line.poses[rows]
        if rows[0] <= self._last:
            return self._tracker.follow(q, poses)
        return self._tracker.leave(q, poses, float(self._line.poses[rows[0] - 1, 0]))

    def _permit(self, leg: int) -> None:
        """Let the arm touch what the rule of a leg allows."""
        match self._path.rules[self._path.phases[leg]].contacts:
            case Contacts.OBJECTS:
                self._collisions.allow(range(len(self._scene.objects)))
            case Contacts.TARGET:
                self._collisions.allow([self._scene.target_index])
            case _:
                self._collisions.allow([])

    def _is_out(self, track: Track, leg: int) -> bool:
        """Whether a leg that ends early has led far enough out of the shelf."""
        enough = WITHDRAWN if self._path.phases[leg] is Phase.WITHDRAW else OUTSIDE
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
