"""Time-optimal path parametrisation: from rest to rest, within limits, and never creeping."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("toppra")

from phframe.core import FloatArray
from phframe.motion.toppra_ import SPACING, TimedPath, time_optimal

pytestmark = pytest.mark.needs_baxter

SPEEDS = np.array([1.35, 1.35, 1.35, 1.35, 3.6, 3.6, 3.6, 0.1, 0.2])
ACCELERATIONS = np.array([6.0] * 7 + [5.0, 3.0])
"""Of seven joints, the opening and the way of the fingertip, as Baxter's motion planner has them."""
WAY = 8
SLACK = 1.0 + 1e-9
BENT = 1.05
"""The mean speed between two samples, where a spline bends."""


def nominal(path: FloatArray) -> float:
    """Time at full speed, and to stop and go where the path turns around (s)."""
    at_full_speed = (np.abs(np.diff(path, axis=0)) / SPEEDS).max(axis=1).sum()
    bends = (np.abs(np.diff(path, 2, axis=0)) / ACCELERATIONS).max(axis=1, initial=0.0)
    return float(at_full_speed + 2.0 * np.sqrt(bends).sum())


def check(path: FloatArray) -> TimedPath:
    found = time_optimal(path, SPEEDS, ACCELERATIONS)
    assert found.times[0] == 0.0
    assert (np.diff(found.times) > 0.0).all()
    assert np.diff(found.times).max() <= 1.5 * SPACING
    np.testing.assert_allclose(found.values[[0, -1]], path[[0, -1]], atol=1e-3)
    assert np.abs(found.speeds[[0, -1]] / SPEEDS).max() < 1e-3, "from rest to rest"
    assert (np.abs(found.speeds) <= SPEEDS * SLACK).all()
    accelerations = np.abs(np.diff(found.speeds, axis=0)) / np.diff(found.times)[:, None]
    assert (accelerations <= ACCELERATIONS * SLACK).all()
    steps = np.abs(np.diff(found.values, axis=0)) / np.diff(found.times)[:, None]
    assert (steps <= SPEEDS * BENT).all(), "speeds are those of the values"
    return found


def walk(rng: np.random.Generator, points: int, jitter: float) -> FloatArray:
    """Joints along a fingertip's straight way in steps of 5 mm, some of them out of line."""
    way = np.arange(points) * 0.005
    joints = way[:, None] * rng.normal(0.0, 2.0, 7)
    joints += (rng.random((points, 1)) < 0.2) * jitter * rng.normal(size=(points, 7))
    return np.column_stack([joints, np.full(points, 0.035), way])


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32), points=st.integers(2, 120), jitter=st.sampled_from([0.0, 1e-6, 1e-4, 1e-3]))
def test_paths_as_they_come_are_driven_quickly_within_limits(seed: int, points: int, jitter: float) -> None:
    path = walk(np.random.default_rng(seed), points, jitter)
    found = check(path)
    assert found.times[-1] <= 3.0 * nominal(path) + 0.5
    assert found.times[-1] >= (np.abs(path[-1] - path[0]) / SPEEDS).max() / SLACK


CREPT = (9, 119, 169, 204, 679, 843, 1059, 1159, 1204, 1208, 1329)
"""Seeds of paths for which TOPP-RA alone, on a grid of the path's own points, took 90 to 240 s instead of 1 to 3."""


@pytest.mark.parametrize("seed", CREPT)
def test_no_path_makes_it_creep(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = int(rng.integers(2, 60))
    rng.normal(size=7)
    rng.uniform()
    stepping = (rng.random((points, 1)) < 0.2) * rng.normal(size=(points, 7)) * 0.02
    path = np.column_stack([np.cumsum(stepping, axis=0), np.full(points, 0.035), np.arange(points) * 0.005])
    assert check(path).times[-1] <= 3.0 * nominal(path) + 0.5


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32), points=st.integers(2, 40))
def test_unevenly_spaced_points_are_no_trouble(seed: int, points: int) -> None:
    rng = np.random.default_rng(seed)
    way = np.concatenate([[0.0], np.cumsum(10.0 ** rng.uniform(-7.0, -1.5, points - 1))])
    path = np.column_stack([way[:, None] * rng.normal(0.0, 2.0, 7), np.full(points, 0.035), way])
    assert check(path).times[-1] <= 3.0 * nominal(path) + 0.5


def rest(points: int) -> FloatArray:
    return np.tile(np.append(np.linspace(-1.0, 1.0, 7), [0.04, 0.0]), (points, 1))


@pytest.mark.parametrize("points", [1, 2, 3, 50])
def test_a_path_that_goes_nowhere_is_a_short_rest(points: int) -> None:
    path = rest(points)
    found = time_optimal(path, SPEEDS, ACCELERATIONS)
    assert 0.0 < found.times[-1] <= 0.1
    assert (found.values == path[0]).all()
    assert not found.speeds.any()


def test_repeated_points_change_nothing_but_a_little_time() -> None:
    path = walk(np.random.default_rng(1), 30, 0.0)
    assert check(np.repeat(path, 3, axis=0)).times[-1] == pytest.approx(check(path).times[-1], rel=1e-6)


def test_many_steps_that_are_each_too_short_to_count_lead_to_the_end_all_the_same() -> None:
    begin, end = rest(1)[0], rest(1)[0]
    end[:7] += 0.05
    path = np.linspace(begin, end, 2000)
    assert (np.abs(np.diff(path, axis=0)) / SPEEDS).max() < 1e-4
    found = check(path)
    assert found.values[-1] == pytest.approx(end)


def test_when_only_the_opening_changes_the_joints_stand_still() -> None:
    path = rest(2)
    path[1, 7] = 0.06
    found = check(path)
    assert np.abs(np.ptp(found.values[:, :7], axis=0)).max() < 1e-12
    assert 0.2 < found.times[-1] < 0.3
