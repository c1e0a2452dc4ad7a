"""Search over configurations from which an arm can follow a path: seed configurations, then random ones."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import cycle, islice

import numpy as np

from phframe.core import FloatArray, Unreachable
from phframe.motion.budget import SearchBudget
from phframe.motion.cartesian_path import CartesianPathFollower, JointPath, pose_text
from phframe.motion.null_space_objective import NullSpaceObjective
from phframe.motion.pinocchio_ import Kinematics

ALIKE = 0.2
"""Configurations that differ by less than this in every joint (rad or m) are tried once."""
IMPROVEMENTS = 20
"""Of the null-space objective of a configuration before it is tried."""
DESCENTS = 15
"""Random starting points of the inverse kinematics for every configuration that may be tried."""
WIDE = 0.01
"""A joint path on which the arm is wider than described by no more than this (m) ends the search."""
ROUGHLY = 3
"""Every how many waypoints a path is looked at before it is followed closely."""
YAW_STEP = 5.0
"""Between the yaws by which the gripper is turned against a path, for want of a joint path at its own yaw (degrees)."""
TURNED = 3
"""Of so many configurations, those that went farthest."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A configuration for one pose of a path, and how far it led.

    Attributes:
        joints: Joint values ``(dof,)``.
        row: Of the pose.
        yaw: By which the gripper is turned against the path (rad).
        excess: By how much the arm is wider on the way than it is described (m); infinite where it does not get through.
        ending: Where and why it does not get through.
    """

    joints: FloatArray
    row: int
    yaw: float = 0.0
    excess: float = math.inf
    ending: Unreachable | None = None


class ConfigurationSearch:
    """The search for one path: made, asked once and dropped.

    Args:
        paths: Finds joint paths for the gripper path.
        kinematics: Of the arm.
        objective: Says how wide the arm is.
        yaw_tolerance: Most by which the gripper is turned against the path (rad).
        budget: Of which it needs the time.
    """

    def __init__(
        self,
        paths: CartesianPathFollower,
        kinematics: Kinematics,
        objective: NullSpaceObjective,
        yaw_tolerance: float,
        budget: SearchBudget,
    ) -> None:
        self._paths, self._kinematics, self._objective, self._budget = paths, kinematics, objective, budget
        self._yaws = _steps_to(yaw_tolerance)
        self._failed: list[Candidate] = []

    def joint_paths(self, seeds: Sequence[FloatArray], attempts: int, rng: np.random.Generator) -> Iterator[JointPath]:
        """Joint paths, the narrowest first: near seeds ``(dof,)``; else turned against the path; else at random.

        Args:
            seeds: Where to look first.
            attempts: Configurations to be tried at random.
            rng: The only source of randomness.
        """
        gate, random = self._paths.gate, self._random_seeds(attempts, rng)
        yield from self._followed(self._tried(self._configurations((seed, gate) for seed in seeds)))
        yield from self._followed(self._turned())
        yield from self._followed(self._tried(islice(self._configurations(random), attempts)))

    def first(self, seeds: Sequence[FloatArray], stride: int) -> JointPath | None:
        """The first joint path that seeds ``(dof,)`` lead to, wide or not, looked at every so many waypoints."""
        gate = self._paths.gate
        for candidate in self._configurations((seed, gate) for seed in seeds):
            found = self._paths.through(candidate.joints, candidate.row, candidate.yaw, stride)
            if isinstance(found, JointPath):
                return found
            self._failed.append(replace(candidate, ending=found))
        return None

    @property
    def farthest(self) -> Unreachable:
        """Where and why the joint path ends that gets farthest."""
        endings = [candidate.ending for candidate in self._failed if candidate.ending is not None]
        where = pose_text(self._paths.pose(self._paths.gate))
        none = Unreachable(0.0, f"out of reach: inverse kinematics finds no joint values for {where}", 0)
        return max(endings, key=lambda ending: ending.where, default=none)

    def _followed(self, candidates: Iterable[Candidate]) -> Iterator[JointPath]:
        """The joint paths of candidates that get through: narrow ones as they come, then the others, narrowest first."""
        others: list[Candidate] = []
        for candidate in candidates:
            if candidate.ending is not None:
                self._failed.append(candidate)
            elif candidate.excess <= WIDE:
                yield from self._followed_closely(candidate)
            else:
                others.append(candidate)
        for candidate in sorted(others, key=lambda one: one.excess):
            yield from self._followed_closely(candidate)

    def _followed_closely(self, candidate: Candidate) -> Iterator[JointPath]:
        """The joint path of a candidate that gets through roughly, if it does so at every waypoint."""
        found = self._paths.through(candidate.joints, candidate.row, candidate.yaw, 1)
        if isinstance(found, JointPath):
            yield found
        else:
            self._failed.append(replace(candidate, ending=found))

    def _tried(self, candidates: Iterable[Candidate]) -> Iterator[Candidate]:
        """How far candidates lead, roughly."""
        for candidate in candidates:
            if self._budget.expired():
                return
            found = self._paths.through(candidate.joints, candidate.row, candidate.yaw, ROUGHLY)
            if isinstance(found, Unreachable):
                yield replace(candidate, ending=found)
            else:
                yield replace(candidate, excess=self._excess(found))

    def _turned(self) -> Iterator[Candidate]:
        """What went farthest, turned against the path; of each no more than one."""
        for failed in sorted(self._failed, key=_way, reverse=True)[:TURNED]:
            yaws = self._yaws_from(failed.ending)
            for candidate in self._tried(Candidate(failed.joints, failed.row, yaw) for yaw in yaws):
                yield candidate
                if candidate.ending is None:
                    break

    def _random_seeds(self, attempts: int, rng: np.random.Generator) -> Iterator[tuple[FloatArray, int]]:
        """Joint values all over the limits, for where the path is deepest and for the gate in turn."""
        rows = cycle((self._paths.deepest, self._paths.gate))
        for _ in range(DESCENTS * attempts):
            yield rng.uniform(self._kinematics.lower, self._kinematics.upper), next(rows)

    def _configurations(self, seeds: Iterable[tuple[FloatArray, int]]) -> Iterator[Candidate]:
        """Different configurations for poses of the path, by descent from seeds, at their best."""
        found: list[tuple[FloatArray, int]] = []
        for seed, row in seeds:
            pose, follower = self._paths.pose(row), self._paths.follower(row)
            q = self._kinematics.descend_to(follower.target(pose), seed)
            if q is None or any(at == row and float(np.abs(q - other).max()) < ALIKE for other, at in found):
                continue
            found.append((q, row))
            improved = follower.improved(q, pose, IMPROVEMENTS)
            if improved is not None:
                yield Candidate(improved, row)

    def _excess(self, path: JointPath) -> float:
        """The most by which the arm is wider on a joint path than it is described (m)."""
        return max(self._objective.excess(q, pose) for q, pose in zip(path.joints, path.poses, strict=True))

    def _yaws_from(self, ending: Unreachable | None) -> Iterator[float]:
        """Yaws to try where a joint path ends (rad), least first: away from a wall."""
        bodies = () if ending is None else ending.bodies
        signs = (1.0,) if "north wall" in bodies else (-1.0,) if "south wall" in bodies else (1.0, -1.0)
        for yaw in self._yaws:
            yield from (sign * yaw for sign in signs)


def _way(candidate: Candidate) -> float:
    return 0.0 if candidate.ending is None else candidate.ending.where


def _steps_to(tolerance: float) -> tuple[float, ...]:
    """Yaws up to a tolerance (rad), it among them, ``YAW_STEP`` apart."""
    whole = math.floor(math.degrees(tolerance) / YAW_STEP + 1e-9)
    steps = [math.radians(YAW_STEP * step) for step in range(1, whole + 1)]
    return tuple(steps) if tolerance <= sum(steps[-1:]) + 1e-9 else (*steps, tolerance)
