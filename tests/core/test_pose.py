"""The algebra of poses."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import FloatArray, compose, inverse, planar_pose, rotate, rotation_matrix, tilt_of, yaw_of

lengths = st.floats(-2.0, 2.0)
angles = st.floats(-math.pi, math.pi)
IDENTITY = planar_pose(0.0, 0.0)


@st.composite
def poses(draw: st.DrawFn) -> FloatArray:
    position = [draw(lengths) for _ in range(3)]
    axis = np.array([draw(st.floats(-1.0, 1.0)) for _ in range(3)]) + np.array([0.0, 0.0, 1e-3])
    half = draw(angles) / 2.0
    return np.array([*position, math.cos(half), *(math.sin(half) * axis / np.linalg.norm(axis))])


def matrix(pose: FloatArray) -> FloatArray:
    """The homogeneous matrix of a pose, column by column."""
    columns = [rotate(pose[3:], axis) for axis in np.eye(3)]
    return np.block([[np.column_stack(columns), pose[:3, None]], [np.zeros((1, 3)), np.ones((1, 1))]])


@given(poses(), poses())
def test_composing_multiplies_matrices(a: FloatArray, b: FloatArray) -> None:
    np.testing.assert_allclose(matrix(compose(a, b)), matrix(a) @ matrix(b), atol=1e-12)


@given(poses())
def test_a_pose_and_its_inverse_make_the_identity(pose: FloatArray) -> None:
    np.testing.assert_allclose(compose(pose, inverse(pose)), IDENTITY, atol=1e-12)
    np.testing.assert_allclose(compose(inverse(pose), pose), IDENTITY, atol=1e-12)
    np.testing.assert_array_equal(compose(IDENTITY, pose)[:3], pose[:3])


@given(poses(), poses(), poses())
def test_composing_is_associative(a: FloatArray, b: FloatArray, c: FloatArray) -> None:
    np.testing.assert_allclose(compose(compose(a, b), c), compose(a, compose(b, c)), atol=1e-12)


@given(poses())
def test_matrices_are_rotations(pose: FloatArray) -> None:
    block = matrix(pose)[:3, :3]
    np.testing.assert_allclose(block @ block.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(block) > 0.0


@given(lengths, lengths, lengths, angles)
def test_a_planar_pose_has_its_yaw_and_stands_upright(x: float, y: float, z: float, yaw: float) -> None:
    pose = planar_pose(x, y, z, yaw)
    np.testing.assert_array_equal(pose[:3], [x, y, z])
    np.testing.assert_allclose(
        [math.cos(yaw_of(pose)), math.sin(yaw_of(pose))], [math.cos(yaw), math.sin(yaw)], atol=1e-9
    )
    assert tilt_of(pose) == 0.0
    np.testing.assert_allclose(matrix(pose)[:2, :2], rotation_matrix(yaw), atol=1e-12)


@given(poses())
def test_tilt_is_the_angle_to_the_vertical(pose: FloatArray) -> None:
    np.testing.assert_allclose(math.cos(tilt_of(pose)), matrix(pose)[2, 2], atol=1e-12)
    tumbled = compose(pose, planar_pose(0.0, 0.0, 0.0, 1.0))
    np.testing.assert_allclose(math.cos(tilt_of(tumbled)), math.cos(tilt_of(pose)), atol=1e-12)


def test_a_quarter_turn_to_the_left() -> None:
    there = compose(planar_pose(1.0, 0.0, 0.0, math.pi / 2.0), planar_pose(0.5, 0.0))
    np.testing.assert_allclose(there[:3], [1.0, 0.5, 0.0], atol=1e-12)
    object_poses = np.array([0.0, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0])
    assert math.isclose(tilt_of(object_poses), math.pi / 2.0)
