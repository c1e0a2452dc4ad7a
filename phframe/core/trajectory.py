"""Paths with times: of the gripper alone, cheap and for any arm, and of the joints of one real arm."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from phframe.core.errors import InputError
from phframe.core.gripper_path import GripperPath, Phase, PhaseRule
from phframe.core.value import FloatArray, Floats, Value


@dataclass(frozen=True, slots=True, eq=False)
class GripperTrajectory(Value):
    """Timed fingertip poses; linear in between.

    Attributes:
        times: ``(k,)`` seconds from 0, not decreasing.
        poses: ``(k, 3)`` x, y (m), yaw (rad) in the shelf frame.
        openings: ``(k,)`` distance between the fingers (m).
        phases: One per leg, ``k - 1``.
        force_limit: Net contact force (N) above which the arm stalls.

    Raises:
        InputError: If the lengths disagree, a number is not finite or times fall.
    """

    times: Floats
    poses: Floats
    openings: Floats
    phases: tuple[Phase, ...]
    force_limit: float

    def __post_init__(self) -> None:
        self._freeze("times", "poses", "openings")
        samples = len(self.phases) + 1
        if self.times.shape != (samples,) or self.poses.shape != (samples, 3) or self.openings.shape != (samples,):
            raise InputError(
                f"a trajectory of {samples - 1} legs needs {samples} times, poses (x, y, yaw) and openings"
            )
        numbers = (self.times, self.poses, self.openings, np.asarray(self.force_limit))
        if not all(np.isfinite(array).all() for array in numbers):
            raise InputError("a trajectory holds values that are not finite numbers")
        if samples < 2 or (np.diff(self.times) < 0.0).any():
            raise InputError("a trajectory needs at least one leg, and times that do not fall")
        if self.force_limit <= 0.0:
            raise InputError(f"the force limit must be above 0 N, not {self.force_limit:g} N")

    @property
    def duration(self) -> float:
        """Seconds from the first pose to the last."""
        return float(self.times[-1])

    def at(self, time: float) -> tuple[FloatArray, float]:
        """Fingertip pose ``(3,)`` and opening (m) at a time (s), held at the ends."""
        pose = np.array([np.interp(time, self.times, self.poses[:, i]) for i in range(3)])
        return pose, float(np.interp(time, self.times, self.openings))

    def phase_at(self, time: float) -> Phase:
        """The phase that a time (s) falls into."""
        leg = int(np.searchsorted(self.times, time, side="right")) - 1
        return self.phases[min(max(leg, 0), len(self.phases) - 1)]


@dataclass(frozen=True, slots=True, eq=False)
class JointTrajectory(Value):
    """What one real arm does: joints at the times of the gripper trajectory that they produce.

    Attributes:
        gripper: The fingertip's poses seen from above at the same ``k`` times; carries openings, phases and force limit.
        positions: ``(k, dof)`` joint values (rad or m).
        velocities: ``(k, dof)`` joint speeds (rad/s or m/s); 0 where the path has a corner.

    Raises:
        InputError: If the lengths disagree or a number is not finite.
    """

    gripper: GripperTrajectory
    positions: Floats
    velocities: Floats

    def __post_init__(self) -> None:
        self._freeze("positions", "velocities")
        samples = len(self.gripper.times)
        if self.positions.ndim != 2 or len(self.positions) != samples or self.velocities.shape != self.positions.shape:
            raise InputError(
                f"a joint trajectory of {samples} samples cannot have positions {self.positions.shape} "
                f"and velocities {self.velocities.shape}"
            )
        if not (np.isfinite(self.positions).all() and np.isfinite(self.velocities).all()):
            raise InputError("a joint trajectory holds values that are not finite numbers")

    def sample(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Joint values and speeds ``(m, dof)`` at times ``(m,)`` (s): cubic between samples, held at the ends."""
        t = np.clip(np.asarray(times, dtype=np.float64), self.times[0], self.times[-1])
        leg = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.times) - 2)
        span = np.diff(self.times)[leg, None]
        u = (t - self.times[leg])[:, None] / np.where(span > 0.0, span, 1.0)
        p0, p1 = self.positions[leg], self.positions[leg + 1]
        m0, m1 = self.velocities[leg] * span, self.velocities[leg + 1] * span
        values = p0 + u * (m0 + u * (3.0 * (p1 - p0) - 2.0 * m0 - m1 + u * (2.0 * (p0 - p1) + m0 + m1)))
        slope = m0 + u * (6.0 * (p1 - p0) - 4.0 * m0 - 2.0 * m1 + u * (6.0 * (p0 - p1) + 3.0 * (m0 + m1)))
        return values, slope / np.where(span > 0.0, span, 1.0)

    @property
    def times(self) -> FloatArray:
        """Seconds from 0 ``(k,)``."""
        return self.gripper.times

    @property
    def duration(self) -> float:
        """Seconds from the first sample to the last."""
        return self.gripper.duration

    @property
    def force_limit(self) -> float:
        """Contact force (N) above which the arm stalls."""
        return self.gripper.force_limit


Trajectory = GripperTrajectory | JointTrajectory


def time_path(path: GripperPath, opening: float, force_limit: float) -> GripperTrajectory:
    """Give a path its times: every leg at the speeds of its rule, whichever of moving, turning and gripping takes longest.

    Args:
        path: The path.
        opening: Distance between the fingers (m) at the start.
        force_limit: Net contact force (N) above which the arm stalls.
    """
    openings = [opening, *(path.rule(leg).opening for leg in range(len(path.phases)))]
    durations = [
        _duration(path.rule(leg), path.poses[leg + 1] - path.poses[leg], openings[leg + 1] - openings[leg])
        for leg in range(len(path.phases))
    ]
    times = np.concatenate([[0.0], np.cumsum(durations)])
    return GripperTrajectory(times, path.poses, np.array(openings), path.phases, force_limit)


def _duration(rule: PhaseRule, step: FloatArray, opening_step: float) -> float:
    moving = float(np.hypot(step[0], step[1])) / rule.speed
    return max(moving, abs(float(step[2])) / rule.turn_speed, abs(opening_step) / rule.finger_speed)


def starting_from(path: GripperPath, pose: FloatArray, rule: PhaseRule) -> GripperPath:
    """The path with an approach leg put before it, from where the gripper is, ``pose`` ``(3,)``."""
    if pose.tobytes() == path.poses[0].tobytes():
        return path
    return replace(
        path,
        poses=np.vstack([pose, path.poses]),
        phases=(Phase.APPROACH, *path.phases),
        rules={Phase.APPROACH: rule, **path.rules},
        overrides={leg + 1: own for leg, own in path.overrides.items()},
    )
