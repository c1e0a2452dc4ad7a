"""Drawn places touch nothing, lie where the method has them, and are given up where there are none; poses beside objects."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import Shelf
from phframe.kinodynamic.approach_poses import approach_poses
from phframe.kinodynamic.places import drawn_place
from tests.pushing.parts import RADIUS, scene_of

SCENE = scene_of((0.45, 0.3), (0.2, 0.3), (0.3, 0.45), (0.3, 0.15))
ROW = SCENE.index("o0")


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32))
def test_a_place_touches_nothing_and_is_as_far_as_it_should_be(seed: int) -> None:
    state = SCENE.initial_state()
    place = drawn_place(SCENE, state, ROW, lambda at: bool(at[1] > 0.4), np.random.default_rng(seed))
    assert place is not None
    others = np.delete(state.positions, ROW, axis=0)
    assert np.linalg.norm(others - place, axis=1).min() >= 2 * RADIUS
    assert (place >= RADIUS).all()
    assert (place <= 0.6 - RADIUS).all()
    assert 0.2 <= np.linalg.norm(place - state.positions[ROW]) <= 0.3
    assert place[1] <= 0.4


def test_where_none_is_near_one_is_drawn_anywhere() -> None:
    wide = scene_of((0.45, 0.3), (0.2, 0.3), shelf=Shelf(0.6, 2.0))
    place = drawn_place(wide, wide.initial_state(), ROW, lambda at: bool(at[1] < 1.2), np.random.default_rng(0))
    assert place is not None
    assert place[1] >= 1.2


def test_where_there_is_none_it_is_given_up() -> None:
    assert drawn_place(SCENE, SCENE.initial_state(), ROW, lambda _: True, np.random.default_rng(0)) is None


@given(st.floats(-math.pi, math.pi), st.floats(0.1, 0.7))
def test_three_poses_are_beside_the_object_the_first_behind_it(angle: float, most: float) -> None:
    center = np.array([0.2, 0.3])
    place = center + 0.25 * np.array([math.cos(angle), math.sin(angle)])
    poses = dict(approach_poses(center, place, 0.06, most))
    assert list(poses) == ["behind", "its left", "its right"]
    offsets = np.array([pose[:2] - center for pose in poses.values()])
    np.testing.assert_allclose(np.linalg.norm(offsets, axis=1), 0.06)
    along = offsets @ ((place - center) / 0.25)
    np.testing.assert_allclose(along, [-0.06, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(offsets[1], -offsets[2], atol=1e-9)
    assert all(abs(pose[2]) <= most for pose in poses.values())


def test_a_gripper_behind_looks_at_the_object() -> None:
    _, pose = next(approach_poses(np.array([0.2, 0.3]), np.array([0.4, 0.4]), 0.06, 0.7))
    assert math.isclose(pose[2], math.atan2(0.1, 0.2), abs_tol=1e-9)
