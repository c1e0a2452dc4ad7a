"""Forward and inverse kinematics of an arm given as URDF, by Pinocchio."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio

from phframe.core import FloatArray

RESTARTS = 30
"""Starting points besides the seed before a pose counts as out of reach."""
INSET = 1e-9
"""Kept from the joint limits (rad or m)."""
EXACT = 1e-9
"""What is left of position (m) and turn (rad) together when a pose counts as reached."""
STEPS = 60
"""Most steps from one starting point."""
PATIENCE = 8
"""Steps without getting nearer by a tenth before a starting point is given up."""
LONGEST_STEP = 0.5
"""Of any joint in one step (rad or m)."""


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

        Found from the seed, else from the starting point nearest to it that gets there.
        """
        if float(np.linalg.norm(pose[:3] - self._root)) > self._longest:
            return None
        for start in self._starts(self._home if seed is None else seed):
            found = self.descend(pose, start)
            if found is not None:
                return found
        return None

    def descend(self, pose: FloatArray, start: FloatArray) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose ``(7,)``, going downhill from ``start`` alone, or None."""
        x, y, z, scalar, i, j, k = pose
        return self.descend_to(pinocchio.XYZQUATToSE3(np.array([x, y, z, i, j, k, scalar])), start)

    def descend_to(self, target: pinocchio.SE3, start: FloatArray) -> FloatArray | None:
        """The same for a pose as Pinocchio has it."""
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

    def places(self, q: FloatArray, direction: FloatArray) -> list[Any]:
        """Where the frames of the chain's joints are, and how they move as the joints move in a direction ``(dof,)``.

        Returns:
            From the base to the tip: rotation ``(3, 3)``, position ``(3,)`` (m), turning ``(3,)`` and velocity ``(3,)``
            per unit of the direction, all in the frame of the root.
        """
        model, data = self._model, self._data
        pinocchio.forwardKinematics(model, data, self._all(q), self._all(direction))
        return [_moving(data.oMi[number], data.v[number]) for number in self._numbers]

    def self_motion(self, q: FloatArray) -> FloatArray:
        """The unit direction ``(dof,)`` in which the joints can move and the tip stays, best so where there are several.

        With more joints than six it leads from one configuration to others with the same fingertip pose.
        """
        pinocchio.computeJointJacobians(self._model, self._data, self._all(q))
        pinocchio.updateFramePlacement(self._model, self._data, self._tip)
        jacobian = pinocchio.getFrameJacobian(self._model, self._data, self._tip, pinocchio.LOCAL)[:, self._rows]
        return np.asarray(np.linalg.svd(jacobian)[2][-1])

    def _reach(self) -> tuple[FloatArray, float]:
        """The first joint's place ``(3,)`` and a distance from it (m) that the tip cannot exceed."""
        frame = self._model.frames[self._tip]
        steps = [self._model.jointPlacements[number].translation for number in range(2, self._model.njoints)]
        slides = np.abs([self.lower, self.upper]).max(axis=0)[
            [not self._model.joints[number].shortname().startswith("JointModelR") for number in self._numbers]
        ]
        length = sum(float(np.linalg.norm(step)) for step in (*steps, frame.placement.translation))
        return self._model.jointPlacements[1].translation, length + float(slides.sum())

    def error(self, q: FloatArray, target: pinocchio.SE3) -> tuple[FloatArray, FloatArray]:
        """The twist ``(6,)`` that is left to a target, seen from the tip, and the tip's Jacobian ``(6, dof)``."""
        model, data, tip = self._model, self._data, self._tip
        pinocchio.computeJointJacobians(model, data, self._all(q))
        left = pinocchio.updateFramePlacement(model, data, tip).actInv(target)
        jacobian = pinocchio.getFrameJacobian(model, data, tip, pinocchio.LOCAL)[:, self._rows]
        return pinocchio.log6(left).vector, jacobian

    def _stepped(self, q: FloatArray, error: FloatArray, jacobian: FloatArray) -> FloatArray:
        """One damped least-squares step; a joint that would leave its limits stays there and the others do its work."""
        free = np.ones(len(q), dtype=np.bool_)
        damping = min(1e-2, float(error @ error)) + 1e-12
        for _ in range(len(q)):
            step = least_squares(jacobian * free, error, damping)
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

    def _starts(self, seed: FloatArray) -> Iterator[FloatArray]:
        yield seed
        distances = np.linalg.norm(self._spread - seed, axis=1)
        yield from self._spread[np.argsort(distances, kind="stable")]

    @cached_property
    def _spread(self) -> FloatArray:
        """Joint values ``(RESTARTS, dof)`` all over the limits, the same ones every time."""
        return np.random.default_rng(0).uniform(self.lower, self.upper, (RESTARTS, len(self.lower)))


def _moving(place: pinocchio.SE3, velocity: pinocchio.Motion) -> tuple[FloatArray, ...]:
    axes = place.rotation
    return axes, place.translation, axes @ velocity.angular, axes @ velocity.linear


def least_squares(jacobian: FloatArray, error: FloatArray, damping: float) -> FloatArray:
    """The smallest step ``(dof,)`` that makes up for an error ``(6,)``; joints whose columns are 0 take no part."""
    return np.asarray(jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping * np.eye(6), error))
