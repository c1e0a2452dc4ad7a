"""Motion planning of the planar arm, whose joints are the gripper's pose in the frame of the base."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

import numpy as np
from pydantic import Field

from phframe.core import (
    Contacts,
    FloatArray,
    GripperPath,
    GripperTrajectory,
    JointTrajectory,
    MotionPlanner,
    Options,
    Phase,
    PhaseRule,
    State,
    Unreachable,
    rotated_in_plane,
    rotation_matrix,
    starting_from,
)
from phframe.motion.trapezoidal_velocity import TrapezoidalProfile, trapezoidal_profile

SPACING = 0.02
"""Between samples (s)."""
Positive = Annotated[float, Field(gt=0.0, le=100.0)]


class PlanarMotionOptions(Options):
    """How the planar arm moves.

    Attributes:
        approach_speed: Of the fingertip outside the shelf (m/s).
        acceleration: Of the fingertip (m/s^2).
        turn_acceleration: Of the yaw (rad/s^2).
        finger_acceleration: Of the opening (m/s^2).
    """

    approach_speed: Annotated[float, Field(gt=0.0, le=1.0)] = 0.5
    acceleration: Positive = 10.0
    turn_acceleration: Positive = 20.0
    finger_acceleration: Positive = 5.0


@dataclass(frozen=True, slots=True, eq=False)
class _Leg:
    """From one knot to the next: knots are x, y, yaw and opening."""

    start: FloatArray
    step: FloatArray
    phase: Phase
    profile: TrapezoidalProfile


class PlanarMotionPlanner(MotionPlanner[PlanarMotionOptions]):
    """Drives straight from corner to corner of a path, coming to rest at each.

    It plans around nothing: the paths are clear of walls, and what may be touched is what they are meant to touch.
    """

    options_type = PlanarMotionOptions

    def plan(
        self, path: GripperPath, state: State, *, attempts: int, seconds: float, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """Plan a joint trajectory; attempts, seconds and the generator play no part."""
        start, opening = self._where(state)
        first = path.rule(0).opening
        path = starting_from(path, start, PhaseRule(self.options.approach_speed, first, Contacts.NONE))
        joints = self._joints_at(path)
        if isinstance(joints, Unreachable):
            return joints
        legs = [leg for leg in self._legs(path, opening) if leg is not None]
        return self._sampled(path, joints, legs, opening)

    def _where(self, state: State) -> tuple[FloatArray, float]:
        """Fingertip pose ``(3,)`` in the shelf frame and commanded opening (m)."""
        if state.arm is None:
            return self.arm.gripper_pose(self.arm.home, self.base_pose), self.arm.shape.min_opening
        own = state.arm.joints
        seen = state.arm.gripper if own is None else self.arm.gripper_pose(own, self.base_pose)
        return seen, state.arm.commanded_opening

    def _joints_at(self, path: GripperPath) -> FloatArray | Unreachable:
        """Joint values ``(m, 3)`` at the corners; limits are the same for x, y and yaw all along, so corners suffice."""
        found: list[FloatArray] = []
        for corner, pose in enumerate(path.poses):
            q = self.arm.inverse(self.arm.fingertip_pose(pose, self.base_pose))
            if q is None:
                x, y, yaw = pose.tolist()
                why = f"x {x:.3f} m, y {y:.3f} m, yaw {yaw:.2f} rad is beyond the joints' limits"
                return Unreachable(_length(path.poses[: max(corner, 1)]), why, max(corner - 1, 0))
            found.append(q)
        return np.array(found)

    def _legs(self, path: GripperPath, opening: float) -> Iterator[_Leg | None]:
        """The legs that move anything."""
        openings = np.array([opening, *(path.rule(leg).opening for leg in range(len(path.phases)))])
        knots = np.column_stack([path.poses, openings])
        for leg, (start, end) in enumerate(pairwise(knots)):
            yield self._leg(start, end - start, path.phases[leg], path.rule(leg))

    def _leg(self, start: FloatArray, step: FloatArray, phase: Phase, rule: PhaseRule) -> _Leg | None:
        """A leg at the speeds that rule and joints allow, or None where nothing moves."""
        o, joints = self.options, self.arm.joints
        ways = np.array([np.hypot(step[0], step[1]), abs(step[2]), abs(step[3])])
        finger = 2.0 * min(joint.velocity for joint in self.arm.fingers.joints)
        speeds = np.array(
            [
                min(rule.speed, joints[0].velocity, joints[1].velocity),
                min(rule.turn_speed, joints[2].velocity),
                min(rule.finger_speed, finger),
            ]
        )
        duration = float((ways / speeds).max())
        if duration < 1e-9:
            return None
        accelerations = np.array([o.acceleration, o.turn_acceleration, o.finger_acceleration])
        return _Leg(start, step, phase, trapezoidal_profile(duration, float((ways / duration / accelerations).max())))

    def _sampled(self, path: GripperPath, joints: FloatArray, legs: list[_Leg], opening: float) -> JointTrajectory:
        """The trajectory of legs that follow one another."""
        start = np.array([*path.poses[0], opening])
        legs = legs or [_Leg(start, np.zeros(4), path.phases[0], trapezoidal_profile(SPACING, SPACING))]
        times, knots, speeds, phases = [np.zeros(1)], [start[None]], [np.zeros((1, 4))], []
        for leg in legs:
            t = leg.profile.times(SPACING)[1:]
            times.append(times[-1][-1] + t)
            knots.append(leg.start + leg.profile.fraction(t)[:, None] * leg.step)
            speeds.append(leg.profile.rate(t)[:, None] * leg.step)
            phases += [leg.phase] * len(t)
        poses, openings = np.vstack(knots)[:, :3], np.vstack(knots)[:, 3]
        gripper = GripperTrajectory(np.concatenate(times), poses, openings, tuple(phases), self.arm.force_limit)
        return JointTrajectory(gripper, *self._in_base(joints[0], poses, np.vstack(speeds)[:, :3]))

    def _in_base(self, first: FloatArray, poses: FloatArray, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Joint values and speeds ``(k, 3)``: the poses as the base sees them, from the first joint values on."""
        rotation = rotation_matrix(self.base_pose.yaw)
        seen, faster = (
            np.column_stack([rotated_in_plane(each[:, :2], rotation), each[:, 2]])
            for each in (poses - poses[0], speeds)
        )
        return first + seen, faster


def _length(poses: FloatArray) -> float:
    return float(np.hypot(*np.diff(poses[:, :2], axis=0).T).sum())
