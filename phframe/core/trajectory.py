"""Paths with times: of the gripper alone, cheap and for any arm, and of the joints of one real arm."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

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
        force_limit: Contact force (N) above which the arm stalls.
    """

    times: Floats
    poses: Floats
    openings: Floats
    phases: tuple[Phase, ...]
    force_limit: float

    def __post_init__(self) -> None:
        self._freeze("times", "poses", "openings")

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
    """What one real arm does: timed joints, and the gripper trajectory they follow.

    Attributes:
        times: ``(k,)`` seconds from 0, not decreasing.
        positions: ``(k, dof)`` joint values (rad or m).
        velocities: ``(k, dof)`` joint speeds (rad/s or m/s).
        openings: ``(k,)`` distance between the fingers (m).
        phases: One per leg, ``k - 1``.
        gripper: Where the fingertip is meant to be; carries the force limit.
    """

    times: Floats
    positions: Floats
    velocities: Floats
    openings: Floats
    phases: tuple[Phase, ...]
    gripper: GripperTrajectory

    def __post_init__(self) -> None:
        self._freeze("times", "positions", "velocities", "openings")

    @property
    def duration(self) -> float:
        """Seconds from the first sample to the last."""
        return float(self.times[-1])

    @property
    def force_limit(self) -> float:
        """Contact force (N) above which the arm stalls."""
        return self.gripper.force_limit


Trajectory = GripperTrajectory | JointTrajectory


def time_path(path: GripperPath, opening: float, force_limit: float) -> GripperTrajectory:
    """Give a path its times: every leg at its phase's speeds, whichever of moving, turning and gripping takes longest.

    Args:
        path: The path.
        opening: Distance between the fingers (m) at the start.
        force_limit: Contact force (N) above which the arm stalls.
    """
    openings = [opening, *(path.rules[phase].opening for phase in path.phases)]
    durations = [
        _duration(path.rules[phase], path.poses[leg + 1] - path.poses[leg], openings[leg + 1] - openings[leg])
        for leg, phase in enumerate(path.phases)
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
    poses = np.vstack([pose, path.poses])
    return replace(path, poses=poses, phases=(Phase.APPROACH, *path.phases), rules={Phase.APPROACH: rule, **path.rules})
