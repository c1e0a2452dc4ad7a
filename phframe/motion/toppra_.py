"""Time-optimal path parametrisation: a path gets its times within limits of speed and acceleration, by TOPP-RA."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint

from phframe.core import FloatArray, IntArray
from phframe.motion.trapezoidal_velocity import trapezoidal_profile

SPACING = 0.02
"""Between samples (s)."""
LEAST = 1e-4
"""Steps shorter than this (s) at full speed count as no step."""
LEAST_GRID = 40
"""Points of the solver's grid."""
FINER, GRIDS = 3, 3
"""Times as many, and grids that are tried: at points of a coarse one it may find that it can hardly go on at all."""
CREEPING = 2.0, 0.5
"""What takes more than so many times its time at full speed, and so many seconds besides, may be creeping."""
BEYOND = 1.1
"""What has to be so many times slower to keep to its limits is tried on a finer grid: between points TOPP-RA exceeds them."""


@dataclass(frozen=True, slots=True, eq=False)
class TimedPath:
    """A path over time, from rest to rest.

    Attributes:
        times: ``(k,)`` from 0 (s).
        values: ``(k, m)``.
        speeds: ``(k, m)``.
    """

    times: FloatArray
    values: FloatArray
    speeds: FloatArray


def time_optimal(path: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> TimedPath:
    """The quickest motion along a path within limits, or where that is not found, a slower one.

    On ``q(s(t))`` the limits are ``|q' s'| <= v`` and ``|q' s'' + q'' s'^2| <= a``; TOPP-RA finds the speeds ``s'^2``
    that can be stopped from, backwards over a grid, and takes the greatest of them, forwards (H. Pham and Q.-C. Pham,
    "A new approach to time-optimal path parameterization based on reachability analysis", 2018).

    Args:
        path: ``(n, m)`` values that follow one another, smoothly joined by cubic splines.
        speeds: Greatest speed of each value ``(m,)``.
        accelerations: Greatest acceleration of each value ``(m,)``.
    """
    path = path[_apart(path, speeds)]
    if len(path) < 2:
        return TimedPath(np.array([0.0, SPACING]), path[[0, 0]], np.zeros((2, path.shape[1])))
    fraction = np.concatenate([[0.0], np.cumsum(_seconds(path, speeds))])
    spline = toppra.SplineInterpolator(fraction, path)
    grid = fraction if len(fraction) >= LEAST_GRID else np.linspace(0.0, fraction[-1], LEAST_GRID)
    found: list[TimedPath] = []
    for _ in range(GRIDS):
        curve = _quickest(spline, grid, speeds, accelerations)
        if curve is not None:
            slower = _excess(_sampled(curve, 1.0), speeds, accelerations)
            found.append(_within(_sampled(curve, slower), speeds, accelerations))
            if slower <= BEYOND and not _creeps(found[-1], fraction):
                return found[-1]
        grid = _divided(grid)
    found.append(_within(_uniform(spline, fraction, speeds, accelerations), speeds, accelerations))
    return min(found, key=lambda each: float(each.times[-1]))


def _excess(found: TimedPath, speeds: FloatArray, accelerations: FloatArray) -> float:
    """How many times slower a motion has to be to keep within its limits at, and from, every sample; at least 1."""
    rates = np.abs(np.diff(found.speeds, axis=0)) / np.diff(found.times)[:, None]
    return max(1.0, float((np.abs(found.speeds) / speeds).max()), float(np.sqrt((rates / accelerations).max())))


def _within(found: TimedPath, speeds: FloatArray, accelerations: FloatArray) -> TimedPath:
    """A motion as much slower all along as it has to be."""
    slower = _excess(found, speeds, accelerations)
    return TimedPath(found.times * slower, found.values, found.speeds / slower)


def _sampled(curve: Any, slower: float) -> TimedPath:
    """A motion of TOPP-RA's at so many samples that they are close enough once it is so much slower."""
    times = np.linspace(0.0, curve.duration, max(2, int(np.ceil(curve.duration * slower / SPACING)) + 1))
    return TimedPath(times, np.asarray(curve(times)), np.asarray(curve(times, 1)))


def _apart(path: FloatArray, speeds: FloatArray) -> IntArray:
    """Rows that are ``LEAST`` or more apart, first and last among them; one row of a path that goes nowhere."""
    kept = [0]
    for row in range(1, len(path)):
        if _between(path[kept[-1]], path[row], speeds) > LEAST:
            kept.append(row)
    last = len(path) - 1
    if kept[-1] != last and len(kept) > 1:
        kept[-1] = last
    return np.array(kept)


def _between(begin: FloatArray, end: FloatArray, speeds: FloatArray) -> float:
    """Time from one to the other at full speed (s)."""
    return float((np.abs(end - begin) / speeds).max())


def _seconds(path: FloatArray, speeds: FloatArray) -> FloatArray:
    """The same along a path, ``(n - 1,)``."""
    return np.asarray((np.abs(np.diff(path, axis=0)) / speeds).max(axis=1))


def _creeps(found: TimedPath, fraction: FloatArray) -> bool:
    """Whether a motion takes far longer than a path should."""
    times, besides = CREEPING
    return float(found.times[-1]) > times * float(fraction[-1]) + besides


def _divided(grid: FloatArray) -> FloatArray:
    """A grid with more points between its points."""
    parts = np.arange(FINER) / FINER
    return np.append((grid[:-1, None] + np.diff(grid)[:, None] * parts).ravel(), grid[-1])


def _quickest(spline: Any, grid: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> Any:
    """TOPP-RA's motion along a spline whose parameter is the time at full speed; None: it finds none."""
    logging.getLogger("toppra").setLevel(logging.ERROR)  # it warns where it finds none
    limits = [
        toppra.constraint.JointVelocityConstraint(np.column_stack([-speeds, speeds])),
        toppra.constraint.JointAccelerationConstraint(np.column_stack([-accelerations, accelerations])),
    ]
    solver = toppra.algorithm.TOPPRA(limits, spline, gridpoints=grid, parametrizer="ParametrizeConstAccel")
    return solver.compute_trajectory(0.0, 0.0)


def _uniform(spline: Any, fraction: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> TimedPath:
    """A trapezoidal velocity profile along a spline, as slow all along as where it has to be slowest."""
    looks = _divided(_divided(fraction))
    slope, bend = np.abs(spline(looks, 1)), np.abs(spline(looks, 2))
    fastest = 1.0 / float((slope / speeds).max())
    curved = float((bend / accelerations).max())
    if curved > 0.0:  # half of the acceleration is for the bends, the other half for getting faster
        fastest = min(fastest, float(np.sqrt(0.5 / curved)))
    gain = 0.5 / float((slope / accelerations).max())
    found, length = trapezoidal_profile(float(fraction[-1]) / fastest, fastest / gain), float(fraction[-1])
    times = found.times(SPACING)
    at = found.fraction(times) * length
    return TimedPath(times, np.asarray(spline(at)), np.asarray(spline(at, 1)) * (found.rate(times) * length)[:, None])
