"""Steps of differential inverse kinematics: damped least squares, and the null space of a Jacobian."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray


def damped_least_squares(jacobian: FloatArray, error: FloatArray, damping: float) -> FloatArray:
    """The step ``(dof,)`` that makes up for an error ``(6,)``, damped where the Jacobian ``(6, dof)`` is near singular.

    ``dq = J^T (J J^T + lambda I)^-1 e``; joints whose columns are 0 take no part. Source: Y. Nakamura and H. Hanafusa,
    "Inverse kinematic solutions with singularity robustness for robot manipulator control", 1986.
    """
    return np.asarray(jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping * np.eye(6), error))


def null_space_direction(jacobian: FloatArray) -> FloatArray:
    """The unit direction ``(dof,)`` in which joints move and the tip stays, most nearly so where there are several.

    The right singular vector of the least singular value: of seven joints' Jacobian ``(6, 7)`` it spans the null space.
    """
    return np.asarray(np.linalg.svd(jacobian)[2][-1])
