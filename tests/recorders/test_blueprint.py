from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from phframe.core import BasePose, FloatArray, Shelf

pytest.importorskip("rerun")

from phframe.recorders.blueprint import FIELD_OF_VIEW, eye_for

pytestmark = pytest.mark.needs_rerun

SHELF = Shelf(0.55, 0.61)
ROBOT = np.array([[-1.17, -1.14, -1.07], [-0.03, 0.70, 0.73]])
"""About as large as Baxter."""


def off_axis(eye: FloatArray, target: FloatArray, point: FloatArray) -> float:
    """The angle (degrees) between where an eye looks and a point."""
    ahead, there = target - eye, point - eye
    return float(np.degrees(np.arccos(ahead @ there / np.linalg.norm(ahead) / np.linalg.norm(there))))


@pytest.mark.parametrize(("y", "robot"), list(product((-0.05, 0.7), (None, ROBOT))))
def test_the_shelf_is_in_view_and_so_is_the_torso_of_a_robot(y: float, robot: FloatArray | None) -> None:
    base = BasePose(-0.675, y, -0.15, 0.0)
    eye, target = eye_for(SHELF, base, robot)
    seen = [np.array(corner) for corner in product((0.0, SHELF.depth), (0.0, SHELF.width), (0.0, SHELF.height))]
    if robot is not None:
        seen += [np.array([base.x, base.y, z]) for z in (base.z, robot[1, 2])]
    assert max(off_axis(eye, target, point) for point in seen) < FIELD_OF_VIEW / 2.0
    assert (eye[1] - 0.5 * SHELF.width) * (y - 0.5 * SHELF.width) < 0.0, "from the side on which the arm does not stand"
