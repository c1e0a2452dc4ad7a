"""Paths get their times from the speeds of their phases; joints are cubic in between."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import (
    Contacts,
    GripperPath,
    GripperTrajectory,
    InputError,
    JointTrajectory,
    Phase,
    PhaseRule,
    starting_from,
    time_path,
)

INSERT = PhaseRule(0.25, 0.0, Contacts.OBJECTS)
TURN = PhaseRule(0.5, 0.0, Contacts.NONE, turn_speed=0.5)
GRASP = PhaseRule(0.1, 0.02, Contacts.MANIPULAND, finger_speed=0.04)
RULES = {Phase.INSERT: INSERT, Phase.REACH: TURN, Phase.GRASP: GRASP}
POSES = [[0.0, 0.0, 0.0], [0.3, 0.4, 0.0], [0.3, 0.5, 1.0], [0.3, 0.5, 1.0]]


def path() -> GripperPath:
    return GripperPath(np.array(POSES), (Phase.INSERT, Phase.REACH, Phase.GRASP), RULES)


def test_every_leg_takes_as_long_as_its_slowest_part() -> None:
    timed = time_path(path(), 0.08, 60.0)
    # 0.5 m at 0.25 m/s; one radian at 0.5 rad/s; fingers from 0 to 0.02 m at 0.04 m/s. The first leg also closes by 0.08 m.
    np.testing.assert_allclose(timed.times, [0.0, 2.0, 4.0, 4.5])
    np.testing.assert_allclose(timed.openings, [0.08, 0.0, 0.0, 0.02])
    assert timed.phases == path().phases
    assert timed.duration == 4.5
    assert timed.force_limit == 60.0


def test_fingers_can_be_the_slowest() -> None:
    assert time_path(path(), 0.28, 60.0).times[1] == pytest.approx(2.8)


def test_between_its_samples_a_trajectory_is_linear_and_beyond_them_it_stands() -> None:
    timed = time_path(path(), 0.08, 60.0)
    pose, opening = timed.at(1.0)
    np.testing.assert_allclose(pose, [0.15, 0.2, 0.0])
    assert opening == pytest.approx(0.04)
    np.testing.assert_allclose(timed.at(-1.0)[0], POSES[0])
    np.testing.assert_allclose(timed.at(99.0)[0], POSES[-1])


@pytest.mark.parametrize(
    ("time", "phase"),
    [
        (-1.0, Phase.INSERT),
        (0.0, Phase.INSERT),
        (1.9, Phase.INSERT),
        (2.0, Phase.REACH),
        (4.2, Phase.GRASP),
        (9.0, Phase.GRASP),
    ],
)
def test_a_time_falls_into_a_phase(time: float, phase: Phase) -> None:
    assert time_path(path(), 0.0, 60.0).phase_at(time) is phase


def test_an_approach_leads_from_where_the_gripper_is() -> None:
    rule = PhaseRule(0.5, 0.0, Contacts.NONE)
    longer = starting_from(path(), np.array([-0.1, 0.0, 0.0]), rule)
    assert longer.phases == (Phase.APPROACH, *path().phases)
    np.testing.assert_allclose(longer.poses[:2], [[-0.1, 0.0, 0.0], POSES[0]])
    assert time_path(longer, 0.0, 60.0).times[1] == pytest.approx(0.2)
    assert starting_from(path(), np.zeros(3), rule) is not longer
    assert starting_from(path(), np.zeros(3), rule) == path()


@pytest.mark.parametrize(
    ("poses", "phases", "rules", "message"),
    [
        (POSES[:2], (Phase.INSERT, Phase.REACH), RULES, r"2 legs needs 3 poses \(x, y, yaw\), not \(2, 3\)"),
        ([[0.0, 0.0], [1.0, 0.0]], (Phase.INSERT,), RULES, r"not \(2, 2\)"),
        ([[0.0, 0.0, 0.0], [np.nan, 0.0, 0.0]], (Phase.INSERT,), RULES, "not a finite number"),
        (POSES[:2], (Phase.SWEEP,), RULES, "says no speed for: sweep"),
    ],
    ids=["too few poses", "no yaw", "not a number", "no rule"],
)
def test_bad_paths_are_refused(poses: object, phases: tuple, rules: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        GripperPath(poses, phases, rules)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"times": [0.0, 1.0]}, "3 legs needs 4 times"),
        ({"openings": [0.0]}, "3 legs needs 4 times"),
        ({"poses": [[0.0, 0.0, np.inf]] * 4}, "not finite numbers"),
        ({"force_limit": np.nan}, "not finite numbers"),
        ({"times": [0.0, 2.0, 1.0, 3.0]}, "do not fall"),
        ({"force_limit": -1.0}, "above 0 N"),
    ],
    ids=["times", "openings", "infinite", "force limit", "falling", "negative force limit"],
)
def test_bad_trajectories_are_refused(change: dict, message: str) -> None:
    timed = time_path(path(), 0.0, 60.0)
    fields = {name: getattr(timed, name) for name in ("times", "poses", "openings", "phases", "force_limit")}
    with pytest.raises(InputError, match=message):
        GripperTrajectory(**{**fields, **change})


def joints(times: list[float], positions: list[list[float]], velocities: list[list[float]]) -> JointTrajectory:
    samples = len(times)
    gripper = GripperTrajectory(
        np.array(times), np.zeros((samples, 3)), np.zeros(samples), (Phase.SWEEP,) * (samples - 1), 60.0
    )
    return JointTrajectory(gripper, np.array(positions), np.array(velocities))


def test_joint_samples_are_met_exactly_and_held_at_the_ends() -> None:
    lifted = joints([0.0, 1.0, 3.0], [[0.0, 1.0], [0.5, -1.0], [2.0, 0.0]], [[0.0, 0.0], [0.7, -0.2], [0.0, 0.0]])
    values, speeds = lifted.sample([0.0, 1.0, 3.0, -5.0, 9.0])
    np.testing.assert_allclose(values, lifted.positions[[0, 1, 2, 0, 2]], atol=1e-12)
    np.testing.assert_allclose(speeds, lifted.velocities[[0, 1, 2, 0, 2]], atol=1e-12)


@given(st.lists(st.floats(-2.0, 2.0), min_size=4, max_size=4), st.floats(0.0, 3.0))
def test_a_cubic_is_sampled_exactly(coefficients: list[float], time: float) -> None:
    cubic = np.polynomial.Polynomial(coefficients)
    knots = [0.0, 0.4, 1.7, 3.0]
    lifted = joints(knots, [[cubic(t)] for t in knots], [[cubic.deriv()(t)] for t in knots])
    values, speeds = lifted.sample([time])
    np.testing.assert_allclose(values[0, 0], cubic(time), atol=1e-9)
    np.testing.assert_allclose(speeds[0, 0], cubic.deriv()(time), atol=1e-9)


def test_legs_of_no_duration_are_no_trouble() -> None:
    lifted = joints([0.0, 1.0, 1.0, 2.0], [[0.0], [1.0], [1.0], [2.0]], [[1.0]] * 4)
    values, speeds = lifted.sample(np.linspace(0.0, 2.0, 9))
    np.testing.assert_allclose(values[:, 0], np.linspace(0.0, 2.0, 9), atol=1e-12)
    np.testing.assert_allclose(speeds[:, 0], 1.0, atol=1e-12)


def test_joints_must_fit_the_gripper_trajectory() -> None:
    with pytest.raises(InputError, match=r"a joint trajectory of 2 samples cannot have positions \(1, 1\)"):
        joints([0.0, 1.0], [[0.0]], [[0.0]])
    with pytest.raises(InputError, match="not finite"):
        joints([0.0, 1.0], [[0.0], [np.nan]], [[0.0], [0.0]])
