"""Cartesian waypoints along a gripper path."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import Contacts, GripperPath, Phase, PhaseRule
from phframe.motion.cartesian_waypoints import TURN_SPACING, waypoints

RULES = {Phase.SWEEP: PhaseRule(0.2, 0.0, Contacts.OBJECTS)}
poses = st.lists(st.tuples(st.floats(-0.2, 0.6), st.floats(0.0, 0.6), st.floats(-1.0, 1.0)), min_size=2, max_size=6)


@given(poses, st.booleans(), st.sampled_from([0.002, 0.005, 0.01]))
def test_they_are_close_to_one_another_on_the_path_and_hold_its_corners(
    corners: list[tuple[float, float, float]], twice: bool, spacing: float
) -> None:
    corners = [*corners, corners[-1]] if twice else corners
    path = GripperPath(np.array(corners), (Phase.SWEEP,) * (len(corners) - 1), RULES)
    found = waypoints(path, spacing)
    steps = np.diff(found.poses, axis=0)
    assert np.hypot(steps[:, 0], steps[:, 1]).max() <= spacing * (1.0 + 1e-6)
    assert np.abs(steps[:, 2]).max() <= TURN_SPACING * (1.0 + 1e-6)
    assert set(found.legs.tolist()) == set(range(len(path.phases)))
    assert (np.diff(found.legs) >= 0).all()
    for leg, (begin, end) in enumerate(zip(path.poses[:-1], path.poses[1:], strict=True)):
        rows = np.flatnonzero(found.legs == leg)
        np.testing.assert_allclose(found.poses[rows[-1]], end, atol=1e-12)
        span = end - begin
        fraction = np.linspace(0.0, 1.0, len(rows) + (leg > 0))[-len(rows) :]
        np.testing.assert_allclose(found.poses[rows], begin + fraction[:, None] * span, atol=1e-9)
    ways = np.hypot(*np.diff(path.poses[:, :2], axis=0).T).sum()
    assert math.isclose(found.lengths[-1], ways, abs_tol=1e-9)
    assert found.lengths[0] == 0.0


@given(poses, st.floats(-0.3, 0.3))
def test_turned_they_are_where_they_were(corners: list[tuple[float, float, float]], yaw: float) -> None:
    found = waypoints(GripperPath(np.array(corners), (Phase.SWEEP,) * (len(corners) - 1), RULES), 0.005)
    turned = found.turned(yaw)
    assert (turned.poses[:, :2] == found.poses[:, :2]).all()
    np.testing.assert_allclose(turned.poses[:, 2] - found.poses[:, 2], yaw, atol=1e-12)
    assert turned.lengths is found.lengths
