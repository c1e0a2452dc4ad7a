from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import Condition
from phframe.recorders.frames import Frames, changes, parked_arm, quaternions_xyzw
from tests.recorders.synthetic_episode import SCENE, hand_made, mounted


@given(st.lists(st.integers(0, 2), min_size=1, max_size=30))
def test_what_changes_leave_out_can_be_filled_in(values: list[int]) -> None:
    rows = changes(np.array(values, dtype=np.float64))
    latest = [values[rows[rows <= i][-1]] for i in range(len(values))]
    assert latest == values
    between = [np.interp(i, rows, np.array(values)[rows]) for i in range(rows[-1] + 1)]
    assert between == values[: rows[-1] + 1], "straight lines between them are right too"


def test_only_what_changes_is_kept() -> None:
    assert changes(np.array([[1.0, 2.0]] * 50 + [[1.0, 3.0]] * 50)).tolist() == [0, 49, 50]


def test_falls_are_the_frames_at_which_a_condition_changes() -> None:
    made = hand_made()
    times, states = zip(*made.frames[1], strict=True)
    frames = Frames.gather(np.array(times), states, parked_arm(SCENE, made.arm.shape))
    (fall,) = frames.falls
    assert Condition.TOPPLED in frames.states[fall].conditions
    assert Condition.TOPPLED not in frames.states[fall - 1].conditions


def test_parked_arm_stands_before_the_mouth() -> None:
    arm = mounted().shape
    frames = Frames.gather(np.zeros(1), [SCENE.initial_state()], parked_arm(SCENE, arm))
    assert frames.grippers[0, 0] < 0.0
    assert frames.openings[0] == arm.min_opening


def test_quaternions_have_their_scalar_last() -> None:
    pose = np.array([1.0, 2.0, 3.0, 0.9, 0.1, 0.2, 0.3])
    assert quaternions_xyzw(pose).tolist() == pytest.approx([0.1, 0.2, 0.3, 0.9])
