"""Frames of a motion, gathered into arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from phframe.core import ArmShape, ArmState, FloatArray, IntArray, Scene, State


@dataclass(frozen=True, slots=True)
class Frames:
    """States of the world at moments of one action, as arrays over ``m`` frames and ``n`` objects.

    Attributes:
        times: ``(m,)`` seconds since the episode began.
        states: The world at each.
        poses: ``(m, n, 7)`` of the objects in the shelf frame.
        grippers: ``(m, 3)`` fingertip x, y (m) and yaw (rad) in the shelf frame.
        openings: ``(m,)`` distance between the fingers (m).
    """

    times: FloatArray
    states: tuple[State, ...]
    poses: FloatArray
    grippers: FloatArray
    openings: FloatArray

    @classmethod
    def gather(cls, times: FloatArray, states: Sequence[State], parked: ArmState) -> Frames:
        """Stack at least one state; where no arm is given it is drawn as ``parked``."""
        arms = [state.arm or parked for state in states]
        return cls(
            times,
            tuple(states),
            np.array([state.poses for state in states]),
            np.array([arm.gripper for arm in arms]),
            np.array([arm.opening for arm in arms]),
        )

    @property
    def falls(self) -> tuple[int, ...]:
        """The frames at which the condition of an object has just changed."""
        return tuple(i for i, (a, b) in enumerate(pairwise(self.states), 1) if a.conditions != b.conditions)


def parked_arm(scene: Scene, arm: ArmShape) -> ArmState:
    """Where an arm that is parked is drawn: before the middle of the mouth."""
    return ArmState(np.array([-0.1, scene.shelf.width / 2.0, 0.0]), arm.min_opening)


def quaternions_xyzw(poses: FloatArray) -> FloatArray:
    """The quaternions ``(..., 4)`` of poses ``(..., 7)``, scalar last."""
    return poses[..., [4, 5, 6, 3]]


def changes(values: FloatArray) -> IntArray:
    """The rows of ``(m, ...)`` worth writing down: the first, and the last before and the first after every change."""
    flat = values.reshape(len(values), -1)
    changed = 1 + np.flatnonzero((flat[1:] != flat[:-1]).any(axis=1))
    return np.unique(np.concatenate([[0], changed - 1, changed])).astype(np.int64)
