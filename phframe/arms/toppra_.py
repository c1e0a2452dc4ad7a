"""Gives a path of joints its times, as quick as speeds and accelerations allow, by TOPP-RA (Pham and Pham 2018)."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint

from phframe.core import ArmError, FloatArray

SPACING = 0.02
"""Between samples (s)."""
LEAST = 1e-4
"""Steps shorter than this (s) at full speed count as no step."""
GRID = 3
"""Points of the solver's grid for every step of the path, where that has few."""


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
    values, speed = _at_full_speed(share, path[kept], speeds, accelerations)
    times = np.linspace(0.0, values.duration, max(2, int(np.ceil(values.duration / SPACING)) + 1))
    return Timed(times, np.asarray(values(times)), np.asarray(speed(times)))


def _at_full_speed(share, path, speeds, accelerations):  # type: ignore[no-untyped-def]
    logging.getLogger("toppra").setLevel(logging.ERROR)
    spline = toppra.SplineInterpolator(share, path)
    limits = [
        toppra.constraint.JointVelocityConstraint(np.column_stack([-speeds, speeds])),
        toppra.constraint.JointAccelerationConstraint(np.column_stack([-accelerations, accelerations])),
    ]
    grid = share if len(share) > 20 else np.linspace(0.0, share[-1], GRID * 20)
    solver = toppra.algorithm.TOPPRA(limits, spline, gridpoints=grid, parametrizer="ParametrizeConstAccel")
    found = solver.compute_trajectory(0.0, 0.0)
    if found is None:
        raise ArmError("no times within the joints' limits were found for the path")
    return found, lambda times: found(times, 1)
