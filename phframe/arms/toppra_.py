"""Gives a path of joints its times, as quick as speeds and accelerations allow, by TOPP-RA (Pham and Pham 2018)."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint

from phframe.core import ArmError, FloatArray

SPACING = 0.02
"""Between samples (s)."""
LEAST = 1e-4
"""Steps shorter than this (s) at full speed count as no step."""
LEAST_GRID = 40
"""Points of the solver's grid."""


@dataclass(frozen=True, slots=True, eq=False)
class Timed:
    """A path over time, from rest to rest.

    Attributes:
        times: ``(k,)`` from 0 (s).
        values: ``(k, m)``.
        speeds: ``(k, m)``.
    """

    times: FloatArray
    values: FloatArray
    speeds: FloatArray


def timed(path: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> Timed:
    """The quickest way along a path within limits.

    Args:
        path: ``(n, m)`` values that follow one another, smoothly joined by cubic splines.
        speeds: Greatest speed of each value ``(m,)``.
        accelerations: Greatest acceleration of each value ``(m,)``.

    Raises:
        ArmError: If there is none.
    """
    steps = np.abs(np.diff(path, axis=0) / speeds).max(axis=1)
    kept = np.concatenate([[True], steps > LEAST])
    if kept.sum() < 2:
        return Timed(np.array([0.0, SPACING]), np.array([path[0], path[-1]]), np.zeros((2, path.shape[1])))
    share = np.concatenate([[0.0], np.cumsum(steps[kept[1:]])])
    trajectory = _quickest(share, path[kept], speeds, accelerations)
    times = np.linspace(0.0, trajectory.duration, max(2, int(np.ceil(trajectory.duration / SPACING)) + 1))
    return Timed(times, np.asarray(trajectory(times)), np.asarray(trajectory(times, 1)))


def _quickest(share: FloatArray, path: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> Any:
    """TOPP-RA's trajectory along a spline through a path, whose parameter is the time at full speed."""
    logging.getLogger("toppra").setLevel(logging.ERROR)  # it warns where it finds no trajectory, as is said below
    limits = [
        toppra.constraint.JointVelocityConstraint(np.column_stack([-speeds, speeds])),
        toppra.constraint.JointAccelerationConstraint(np.column_stack([-accelerations, accelerations])),
    ]
    grid = share if len(share) >= LEAST_GRID else np.linspace(0.0, share[-1], LEAST_GRID)
    spline = toppra.SplineInterpolator(share, path)
    solver = toppra.algorithm.TOPPRA(limits, spline, gridpoints=grid, parametrizer="ParametrizeConstAccel")
    found = solver.compute_trajectory(0.0, 0.0)
    if found is None:
        raise ArmError("no times within the joints' limits were found for the path")
    return found
