"""Poses: seven numbers, position (m) then unit quaternion, scalar first: x y z, qw qx qy qz."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from phframe.core.value import FloatArray


def planar_pose(x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> FloatArray:
    """The pose ``(7,)`` at a position (m), turned by ``yaw`` (rad) about the vertical."""
    return np.array([x, y, z, math.cos(yaw / 2.0), 0.0, 0.0, math.sin(yaw / 2.0)])


def yaw_of(pose: ArrayLike) -> float:
    """Heading (rad, in (-pi, pi]) of the x axis of a pose ``(7,)`` seen from above."""
    w, x, y, z = np.asarray(pose, dtype=np.float64)[3:].tolist()
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def tilt_of(pose: ArrayLike) -> float:
    """Angle (rad, in [0, pi]) between the z axis of a pose ``(7,)`` and the vertical."""
    _, x, y, _ = np.asarray(pose, dtype=np.float64)[3:]
    return math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y))))


def seen_from_above(pose: ArrayLike) -> FloatArray:
    """What is seen of a pose ``(7,)`` from above ``(3,)``: x, y and heading."""
    x, y, *_ = np.asarray(pose, dtype=np.float64)
    return np.array([x, y, yaw_of(pose)])


def compose(a: ArrayLike, b: ArrayLike) -> FloatArray:
    """The pose ``(7,)`` of frame b, given in frame a, seen in the frame in which a is given."""
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    return np.concatenate([a[:3] + rotate(a[3:], b[:3]), _multiply(a[3:], b[3:])])


def inverse(pose: ArrayLike) -> FloatArray:
    """The pose ``(7,)`` of the outer frame seen from ``pose``: ``compose(p, inverse(p))`` is the identity."""
    pose = np.asarray(pose, dtype=np.float64)
    conjugate = pose[3:] * np.array([1.0, -1.0, -1.0, -1.0])
    return np.concatenate([-rotate(conjugate, pose[:3]), conjugate])


def rotate(quaternion: FloatArray, vector: FloatArray) -> FloatArray:
    """The vector ``(3,)`` turned by a unit quaternion ``(4,)``, scalar first."""
    twice = 2.0 * np.cross(quaternion[1:], vector)
    return np.asarray(vector + quaternion[0] * twice + np.cross(quaternion[1:], twice))


def _multiply(a: FloatArray, b: FloatArray) -> FloatArray:
    scalar = a[0] * b[0] - a[1:] @ b[1:]
    return np.concatenate([[scalar], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def rotation_matrix(angle: float) -> FloatArray:
    """The matrix ``(2, 2)`` that turns plane vectors by ``angle`` (rad)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def rotated_in_plane(points: FloatArray, matrix: FloatArray) -> FloatArray:
    """Plane vectors ``(..., 2)``, each a row, times rotation matrices ``(..., 2, 2)``: by products and sums alone.

    The bits are then the same on every processor. Those of ``points @ matrix`` are not: BLAS fuses products and sums where
    the processor can.
    """
    x, y = points[..., 0], points[..., 1]
    return np.stack(
        [x * matrix[..., 0, 0] + y * matrix[..., 1, 0], x * matrix[..., 0, 1] + y * matrix[..., 1, 1]], axis=-1
    )
