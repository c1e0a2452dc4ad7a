"""Kinematics of an arm given as URDF: forward, inverse, Jacobians and null space, by Pinocchio."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio

from phframe.core import FloatArray
from phframe.motion.least_squares import damped_least_squares

RESTARTS = 30
"""Starting points besides the seed before a pose counts as out of reach."""
INSET = 1e-9
"""Kept from the joint limits (rad or m)."""
EXACT = 1e-9
"""Norm of the twist (m, rad) that is left when a pose counts as reached."""
STEPS = 60
"""Most iterations of the inverse kinematics from one starting point."""
PATIENCE = 8
"""Iterations without getting nearer by a tenth before a starting point is given up."""
LONGEST_STEP = 0.5
"""Most that any joint moves in one iteration (rad or m)."""


class Kinematics:
    """One chain of joints in a robot; all its other joints stay at 0. Keeps nothing from call to call.

    Args:
        urdf: The robot.
        joints: Names of the joints in the chain, from the base to the tip.
        tip: Name of the link that is moved.
        home: Joint values ``(dof,)`` where searching begins when no seed is given.

    Attributes:
        dof: Number of joints.
        lower: Their limits ``(dof,)`` (rad or m).
        upper: Their limits ``(dof,)``.
    """

    def __init__(self, urdf: str, joints: Sequence[str], tip: str, home: FloatArray) -> None:
        whole = pinocchio.buildModelFromXML(urdf)
        others = [number for number, name in enumerate(whole.names) if number and name not in joints]
        self._model = pinocchio.buildReducedModel(whole, others, pinocchio.neutral(whole))
        self._numbers = [self._model.getJointId(name) for name in joints]
        self._rows = np.array([self._model.idx_qs[number] for number in self._numbers])
        self._data, self._tip, self._home = self._model.createData(), self._model.getFrameId(tip), home
        self.lower = self._model.lowerPositionLimit[self._rows] + INSET
        self.upper = self._model.upperPositionLimit[self._rows] - INSET
        self._root, self._longest = self._reach()
        self.dof = len(joints)

    def forward(self, q: FloatArray) -> FloatArray:
        """Pose ``(7,)`` of the tip, scalar first, in the frame of the robot's root, for joint values ``(dof,)``."""
        pinocchio.framesForwardKinematics(self._model, self._data, self._all(q))
        x, y, z, i, j, k, scalar = pinocchio.SE3ToXYZQUAT(self._data.oMf[self._tip])
        return np.array([x, y, z, scalar, i, j, k])

    def inverse(self, pose: FloatArray, seed: FloatArray | None = None) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose ``(7,)``, or None.

        Found by damped least squares from the seed, else from the starting point nearest to it that gets there.
        """
        if float(np.linalg.norm(pose[:3] - self._root)) > self._longest:
            return None
        for start in self.starts([self._home if seed is None else seed]):
            found = self.descend(pose, start)
            if found is not None:
                return found
        return None

    def descend(self, pose: FloatArray, start: FloatArray) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose ``(7,)``, by damped least squares from ``start`` alone, or None."""
        return self.descend_to(se3(pose), start)

    def descend_to(self, target: pinocchio.SE3, start: FloatArray) -> FloatArray | None:
        """The same for a pose as Pinocchio has it.

        Newton-Raphson with the body Jacobian and the error ``e = log6(T(q)^-1 T*)`` (K. Lynch and F. Park, "Modern
        Robotics", 2017, section 6.2.2), each step damped the more, the farther the pose is (S. R. Buss, "Introduction to
        Inverse Kinematics with Jacobian Transpose, Pseudoinverse and Damped Least Squares methods", 2009).
        """
        q = np.clip(start, self.lower, self.upper)
        least, since = np.inf, 0
        for _ in range(STEPS):
            error, jacobian = self.error(q, target)
            left = float(np.sqrt(error @ error))
            if left < EXACT:
                return q
            least, since = (left, 0) if left < 0.9 * least else (least, since + 1)
            if since > PATIENCE:
                return None
            q = self._stepped(q, error, jacobian)
        return None

    def starts(self, seeds: Sequence[FloatArray]) -> Iterator[FloatArray]:
        """Starting points ``(dof,)`` of the inverse kinematics: seeds, then others all over, nearest the last seed first."""
        yield from seeds
        distances = np.linalg.norm(self._spread - seeds[-1], axis=1)
        yield from self._spread[np.argsort(distances, kind="stable")]

    def joint_frames(self, q: FloatArray, direction: FloatArray) -> list[Any]:
        """Where the frames of the chain's joints are, and how they move as the joints move in a direction ``(dof,)``.

        Returns:
            From the base to the tip: rotation matrix ``(3, 3)``, position ``(3,)`` (m), angular and linear velocity
            ``(3,)`` per unit of the direction, all in the frame of the root.
        """
        model, data = self._model, self._data
        pinocchio.forwardKinematics(model, data, self._all(q), self._all(direction))
        return [_moving(data.oMi[number], data.v[number]) for number in self._numbers]

    def error(self, q: FloatArray, target: pinocchio.SE3) -> tuple[FloatArray, FloatArray]:
        """The twist ``(6,)`` that is left to a target, seen from the tip, and the tip's body Jacobian ``(6, dof)``."""
        model, data, tip = self._model, self._data, self._tip
        pinocchio.computeJointJacobians(model, data, self._all(q))
        left = pinocchio.updateFramePlacement(model, data, tip).actInv(target)
        jacobian = pinocchio.getFrameJacobian(model, data, tip, pinocchio.LOCAL)[:, self._rows]
        return pinocchio.log6(left).vector, jacobian

    def _reach(self) -> tuple[FloatArray, float]:
        """The first joint's place ``(3,)`` and a distance from it (m) that the tip cannot exceed."""
        frame = self._model.frames[self._tip]
        steps = [self._model.jointPlacements[number].translation for number in range(2, self._model.njoints)]
        slides = np.abs([self.lower, self.upper]).max(axis=0)[
            [not self._model.joints[number].shortname().startswith("JointModelR") for number in self._numbers]
        ]
        length = sum(float(np.linalg.norm(step)) for step in (*steps, frame.placement.translation))
        return self._model.jointPlacements[1].translation, length + float(slides.sum())

    def _stepped(self, q: FloatArray, error: FloatArray, jacobian: FloatArray) -> FloatArray:
        """One damped least-squares step; a joint that would leave its limits stays there and the others do its work."""
        free = np.ones(len(q), dtype=np.bool_)
        damping = min(1e-2, float(error @ error)) + 1e-12
        for _ in range(len(q)):
            step = damped_least_squares(jacobian * free, error, damping)
            step *= min(1.0, LONGEST_STEP / max(float(np.abs(step).max()), 1e-12))
            beyond = free & ((q + step > self.upper) & (q >= self.upper) | (q + step < self.lower) & (q <= self.lower))
            if not beyond.any():
                break
            free &= ~beyond
        return np.clip(q + step, self.lower, self.upper)

    def _all(self, q: FloatArray) -> FloatArray:
        """The chain's joint values in the model's order."""
        values = np.empty(len(q))
        values[self._rows] = q
        return values

    @cached_property
    def _spread(self) -> FloatArray:
        """Joint values ``(RESTARTS, dof)`` all over the limits, the same ones every time."""
        return np.random.default_rng(0).uniform(self.lower, self.upper, (RESTARTS, len(self.lower)))


def se3(pose: FloatArray) -> pinocchio.SE3:
    """A pose ``(7,)``, scalar first, as Pinocchio has it."""
    x, y, z, scalar, i, j, k = pose.tolist()
    return pinocchio.XYZQUATToSE3(np.array([x, y, z, i, j, k, scalar]))


def _moving(frame: pinocchio.SE3, velocity: pinocchio.Motion) -> tuple[FloatArray, ...]:
    rotation = frame.rotation
    return rotation, frame.translation, rotation @ velocity.angular, rotation @ velocity.linear
