"""Damped least squares and the null space of a Jacobian, against their definitions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import FloatArray
from phframe.motion.least_squares import damped_least_squares, null_space_direction


def jacobian_of(seed: int, dof: int = 7, rank: int = 6) -> FloatArray:
    rng = np.random.default_rng(seed)
    return np.asarray(rng.normal(size=(6, rank)) @ rng.normal(size=(rank, dof)))


@given(seed=st.integers(0, 2**32), rank=st.integers(1, 6), damping=st.sampled_from([1e-3, 1e-1, 10.0]))
def test_the_step_is_least_in_error_and_length(seed: int, rank: int, damping: float) -> None:
    """``J^T (J J^T + lambda I)^-1 e`` is where ``|J dq - e|^2 + lambda |dq|^2`` is least: its gradient is 0."""
    jacobian, error = jacobian_of(seed, rank=rank), np.random.default_rng(seed).normal(size=6)
    step = damped_least_squares(jacobian, error, damping)
    gradient = jacobian.T @ (jacobian @ step - error) + damping * step
    np.testing.assert_allclose(gradient, 0.0, atol=1e-8 * (1.0 + np.abs(jacobian).max() ** 2))


@given(seed=st.integers(0, 2**32))
def test_joints_without_a_column_take_no_part(seed: int) -> None:
    free = np.array([1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0])
    step = damped_least_squares(jacobian_of(seed) * free, np.ones(6), 1e-9)
    assert step[2] == 0.0
    assert np.abs(step[free > 0.0]).min() > 0.0


@given(seed=st.integers(0, 2**32))
def test_in_the_null_space_the_tip_stays(seed: int) -> None:
    direction = null_space_direction(jacobian_of(seed))
    assert float(np.linalg.norm(direction)) == pytest.approx(1.0)
    np.testing.assert_allclose(jacobian_of(seed) @ direction, 0.0, atol=1e-9)


@pytest.mark.needs_baxter
def test_moved_along_it_baxters_fingertip_stays() -> None:
    pytest.importorskip("pinocchio")
    from phframe.motion.pinocchio_ import se3
    from tests.motion.motions import baxter

    arm = baxter()
    _, jacobian = arm.kinematics.error(arm.home, se3(arm.forward(arm.home)))
    moved = arm.forward(arm.home + 1e-4 * null_space_direction(jacobian))
    np.testing.assert_allclose(moved, arm.forward(arm.home), atol=1e-7)
