"""The null-space objective, and surface points of the arm's collision geometry: slopes are those of the values."""

from __future__ import annotations

from functools import cache
from typing import Any

import hypothesis
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("pinocchio")

from phframe.core import FloatArray, compose, rotate, yaw_of
from phframe.motion.null_space_objective import NullSpaceObjective
from phframe.motion.surface_points import SurfacePoints
from tests.motion.motions import MIDDLE, SHELF, baxter, example

pytestmark = pytest.mark.needs_baxter

ARMS = {"left": baxter, "right": lambda: baxter("right"), "example": example}
STEP = 1e-6


@cache
def surface(name: str) -> SurfacePoints:
    arm = ARMS[name]()
    base_pose = arm.default_base_pose(SHELF)
    return SurfacePoints(arm.kinematics, arm.robot, arm.description.joints, arm.tip_link, base_pose, SHELF.depth)


@cache
def objective(name: str) -> NullSpaceObjective:
    arm = ARMS[name]()
    return NullSpaceObjective(arm.kinematics, surface(name), arm.description.behind, SHELF)


@cache
def of_one_width(name: str) -> NullSpaceObjective:
    """Of an arm described as equally wide all along: slopes are exact for that."""
    arm = ARMS[name]()
    behind = [part.model_copy(update={"widths": ((0.0, 0.06), (1.0, 0.06))}) for part in arm.description.behind]
    return NullSpaceObjective(arm.kinematics, surface(name), behind, SHELF)


def configuration(arm: Any, rng: np.random.Generator) -> FloatArray:
    lower, upper = np.array([[joint.lower, joint.upper] for joint in arm.joints]).T
    return np.asarray(np.clip(arm.home + rng.normal(0.0, 0.5, len(lower)), lower, upper))


def seen(arm: Any, q: FloatArray) -> FloatArray:
    pose = compose(arm.default_base_pose(SHELF).pose, arm.forward(q))
    return np.array([pose[0], pose[1], yaw_of(pose)])


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32), name=st.sampled_from(sorted(ARMS)))
def test_points_move_as_their_speeds_say(seed: int, name: str) -> None:
    arm, rng = ARMS[name](), np.random.default_rng(seed)
    q = configuration(arm, rng)
    direction = rng.normal(size=len(q))
    points, speeds = surface(name).seen(q, direction)
    later, _ = surface(name).seen(q + STEP * direction, direction)
    before, _ = surface(name).seen(q - STEP * direction, direction)
    np.testing.assert_allclose((later - before) / (2.0 * STEP), speeds, atol=1e-6)
    assert len(points) >= 24


def test_points_are_on_the_collision_geometry_of_the_links_behind_the_gripper() -> None:
    """Those of the tube before Baxter's wrist are 0.066 m from its axis, 0.219 m and more behind the fingertip."""
    arm = baxter()
    points, _ = surface("left").seen(arm.home, np.zeros(7))
    pose = compose(arm.default_base_pose(SHELF).pose, arm.forward(arm.home))
    ahead = rotate(pose[3:], np.array([1.0, 0.0, 0.0]))
    behind = -(points - pose[:3]) @ ahead
    across = np.linalg.norm(points - pose[:3] + behind[:, None] * ahead, axis=1)
    assert behind.min() > 0.05
    tube = across[(behind > 0.215) & (behind < 0.22)]
    assert len(tube) >= 8
    assert tube.max() == pytest.approx(0.066, abs=1e-3)


@settings(max_examples=80, deadline=None)
@given(seed=st.integers(0, 2**32), name=st.sampled_from(sorted(ARMS)))
@hypothesis.example(seed=2025, name="left")
def test_slopes_are_those_of_the_residuals(seed: int, name: str) -> None:
    arm, rng, judged = ARMS[name](), np.random.default_rng(seed), of_one_width(name)
    q = configuration(arm, rng)
    direction, gripper = rng.normal(size=len(q)), seen(arm, q)
    points, _ = surface(name).seen(q, direction)
    near = points[rng.integers(len(points), size=3)]
    obstacles = np.column_stack([near[:, :2] + rng.normal(0.0, 0.03, (3, 2)), np.full(3, 0.03), near[:, 2] + 0.02])
    values, slopes = judged.residuals(q, direction, gripper, obstacles)
    found = [judged.residuals(q + sign * STEP * direction, direction, gripper, obstacles)[0] for sign in (1.0, -1.0)]
    if {len(one) for one in found} != {len(values)}:
        return  # an obstacle comes within reach of a point just here
    numeric = (found[0] - found[1]) / (2.0 * STEP)
    kinks = (np.sign(found[0]) != np.sign(found[1])) | (np.abs(values) < 1e-5)
    np.testing.assert_allclose(np.where(kinks, 0.0, numeric), np.where(kinks, 0.0, slopes), atol=2e-4)
    assert (np.abs(slopes) > 1e-6).any()


def test_a_configuration_with_the_forearm_across_is_wider_than_described() -> None:
    """Of the two in figures/baxter_mount.md for the fingertip 0.5 m deep, one has its forearm behind the gripper."""
    arm, judged = baxter(), objective("left")
    straight = arm.description.seed_configurations[0]
    at = seen(arm, np.array(straight))
    assert judged.excess(np.array(straight), at) < 0.03
    angled = np.array([-1.031, -0.07492, 0.87285, 0.73256, 1.39329, 0.51496, 0.71163])
    as_if_straight = seen(arm, angled) * np.array([1.0, 1.0, 0.0])
    assert judged.excess(angled, as_if_straight) > 0.05, "against another yaw, it lies across"


def test_nothing_is_too_wide_before_the_mouth() -> None:
    arm, judged = baxter(), objective("left")
    at = seen(arm, arm.home)
    assert at[0] < 0.0
    assert judged.excess(np.array(arm.home), at + np.array([0.0, 1.0, 0.5])) == 0.0
    assert abs(at[1] - MIDDLE) < 0.2
