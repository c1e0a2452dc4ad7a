"""Looks for postures in which an arm can follow a path, the narrowest of them first."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import cycle, islice

import numpy as np

from phframe.core import FloatArray, Unreachable
from phframe.motion.follow import Follower
from phframe.motion.pinocchio_ import Kinematics
from phframe.motion.route import Route, Router
from phframe.motion.track import Tracker

ALIKE = 0.2
"""Postures that differ by less than this in every joint (rad or m) are tried once."""
IMPROVEMENTS = 20
"""Of a posture before it is tried."""
DESCENTS = 15
"""Random starting points for every posture that may be tried."""
WIDE = 0.01
"""A route on which the arm is wider than described by no more than this (m) is looked for no further."""
ROUGHLY = 3
"""Every how many of its poses a route is looked at before it is made."""
YAWS = tuple(math.radians(degrees) for degrees in (5.0, 10.0, 15.0))
"""How far the gripper may be turned against a path in the shelf, for want of a route at the path's own yaw (rad)."""
TURNED = 3
"""Of so many postures, those that went farthest."""


@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """A posture for one pose of a path, and how far it led.

    Attributes:
        posture: Joint values ``(dof,)``.
        row: Of the pose.
        yaw: By which the gripper is turned against the path (rad).
        excess: By how much the arm is wider on the way than it is described (m); infinite where it does not get through.
        ending: Where and why it does not get through.
    """

    posture: FloatArray
    row: int
    yaw: float = 0.0
    excess: float = math.inf
    ending: Unreachable | None = None


class RouteSearch:
    """The search for one path: made, asked once and dropped.

    Args:
        router: Of the path.
        tracker: That the router follows poses with.
        follower: That the tracker moves joints with.
        kinematics: Of the arm.
        until: When no more postures are tried, by ``time.monotonic`` (s).
    """

    def __init__(
        self, router: Router, tracker: Tracker, follower: Follower, kinematics: Kinematics, until: float
    ) -> None:
        self._until = until
        self._router, self._tracker = router, tracker
        self._follower, self._kinematics = follower, kinematics
        self._failed: list[Trial] = []

    def routes(self, seeds: Sequence[FloatArray], attempts: int, rng: np.random.Generator) -> Iterator[Route]:
        """Routes, the narrowest first: near seeds ``(dof,)``; else turned against the path; else at random.

        Args:
            seeds: Where to look first.
            attempts: Postures to be tried at random.
            rng: The only source of randomness.
        """
        gate, by_chance = self._router.gate, self._by_chance(attempts, rng)
        yield from self._made(self._tried(self._postures((seed, gate) for seed in seeds)))
        yield from self._made(self._turned())
        yield from self._made(self._tried(islice(self._postures(by_chance), attempts)))

    @property
    def farthest(self) -> Unreachable:
        """Where and why the route ends that gets farthest."""
        endings = [trial.ending for trial in self._failed if trial.ending is not None]
        none = Unreachable(0.0, "no posture has the gripper on the path", 0)
        return max(endings, key=lambda ending: ending.where, default=none)

    def _made(self, trials: Iterable[Trial]) -> Iterator[Route]:
        """The routes of trials that get through: narrow ones as they come, then the others, the narrowest first."""
        others: list[Trial] = []
        for trial in trials:
            if trial.ending is not None:
                self._failed.append(trial)
            elif trial.excess <= WIDE:
                yield from self._made_of(trial)
            else:
                others.append(trial)
        for trial in sorted(others, key=lambda one: one.excess):
            yield from self._made_of(trial)

    def _made_of(self, trial: Trial) -> Iterator[Route]:
        """The route of a trial that gets through roughly, if it does so closely looked at."""
        route = self._router.through(trial.posture, trial.row, trial.yaw, 1)
        if isinstance(route, Route):
            yield route
        else:
            self._failed.append(replace(trial, ending=route))

    def _tried(self, trials: Iterable[Trial]) -> Iterator[Trial]:
        """How far trials lead, roughly."""
        for trial in trials:
            if time.monotonic() > self._until:
                return
            route = self._router.through(trial.posture, trial.row, trial.yaw, ROUGHLY)
            if isinstance(route, Unreachable):
                yield Trial(trial.posture, trial.row, trial.yaw, ending=route)
            else:
                yield Trial(trial.posture, trial.row, trial.yaw, self._excess(route))

    def _turned(self) -> Iterator[Trial]:
        """What went farthest, turned against the path; of each no more than one."""
        for failed in sorted(self._failed, key=_way, reverse=True)[:TURNED]:
            for trial in self._tried(Trial(failed.posture, failed.row, yaw) for yaw in _yaws(failed.ending)):
                yield trial
                if trial.ending is None:
                    break

    def _by_chance(self, attempts: int, rng: np.random.Generator) -> Iterator[tuple[FloatArray, int]]:
        """Joint values all over the limits, for where the path is deepest and for the gate in turn."""
        rows = cycle((self._router.deepest, self._router.gate))
        for _ in range(DESCENTS * attempts):
            yield rng.uniform(self._kinematics.lower, self._kinematics.upper), next(rows)

    def _postures(self, seeds: Iterable[tuple[FloatArray, int]]) -> Iterator[Trial]:
        """Different postures for poses of the path, by descent from seeds, at their best."""
        found: list[tuple[FloatArray, int]] = []
        for seed, row in seeds:
            pose = self._router.pose(row)
            q = self._kinematics.descend_to(self._tracker.target(pose), seed)
            if q is None or any(at == row and float(np.abs(q - other).max()) < ALIKE for other, at in found):
                continue
            found.append((q, row))
            self._router.permit(row)
            improved = self._follower.improved(q, self._tracker.target(pose), pose, IMPROVEMENTS)
            if improved is not None:
                yield Trial(improved, row)

    def _excess(self, route: Route) -> float:
        """The most by which the arm is wider on a route than it is described (m)."""
        return max(self._follower.posture.excess(q, pose) for q, pose in zip(route.joints, route.poses, strict=True))


def _way(trial: Trial) -> float:
    return 0.0 if trial.ending is None else trial.ending.where


def _yaws(ending: Unreachable | None) -> Iterator[float]:
    """Yaws to try where a route ends (rad), least first: away from a wall."""
    bodies = () if ending is None else ending.bodies
    signs = (1.0,) if "north wall" in bodies else (-1.0,) if "south wall" in bodies else (1.0, -1.0)
    for yaw in YAWS:
        yield from (sign * yaw for sign in signs)
