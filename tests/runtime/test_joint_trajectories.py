"""The exported joint trajectories are those that were driven."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import Episode, InputError, JointTrajectory
from phframe.runtime.joint_trajectories import as_csv, as_json, joint_trajectories
from phframe.runtime.solve import solve

ARM = PlanarArm(PlanarArmOptions())


@pytest.fixture(scope="module")
def episode() -> Episode:
    pytest.importorskip("mujoco")
    return solve("vieira/simple-03", backend="mujoco")


def seconds(point: dict[str, Any]) -> float:
    time = point["time_from_start"]
    assert all(type(time[unit]) is int and time[unit] >= 0 for unit in ("sec", "nanosec"))
    assert time["nanosec"] < 10**9
    return float(time["sec"] + time["nanosec"] * 1e-9)


@pytest.mark.needs_mujoco
def test_the_arm_of_the_message_is_what_was_driven(episode: Episode) -> None:
    content = json.loads(as_json(episode, joint_trajectories(episode, ARM)))
    assert [each["action"] for each in content["trajectories"]] == [step.action.name for step in episode.steps]
    for each, step in zip(content["trajectories"], episode.steps, strict=True):
        driven = step.trajectory
        assert isinstance(driven, JointTrajectory)
        message = each["arm"]
        assert message["joint_names"] == [joint.name for joint in ARM.joints]
        times = [seconds(point) for point in message["points"]]
        assert times[0] == 0.0
        assert all(a < b for a, b in pairwise(times))
        positions, velocities = driven.sample(times)
        np.testing.assert_allclose([point["positions"] for point in message["points"]], positions, atol=1e-8)
        np.testing.assert_allclose([point["velocities"] for point in message["points"]], velocities, atol=1e-6)
        assert times[-1] == pytest.approx(driven.duration, abs=1e-9)


@pytest.mark.needs_mujoco
def test_between_its_points_the_gripper_is_where_it_was(episode: Episode) -> None:
    for found, each in zip(
        joint_trajectories(episode, ARM),
        json.loads(as_json(episode, joint_trajectories(episode, ARM)))["trajectories"],
        strict=True,
    ):
        points, driven = each["gripper"]["points"], found.trajectory.gripper
        times = [seconds(point) for point in points]
        assert len(points) < len(driven.times) / 2, "a gripper that waits needs no samples"
        for finger in range(2):
            values = np.interp(driven.times, times, [point["positions"][finger] for point in points])
            np.testing.assert_allclose(2.0 * values, driven.openings, atol=1e-6)


@pytest.mark.needs_mujoco
def test_phases_follow_one_another_to_the_end(episode: Episode) -> None:
    grasp = json.loads(as_json(episode, joint_trajectories(episode, ARM, len(episode.steps))))["trajectories"][0]
    phases = grasp["phases"]
    assert [each["phase"] for each in phases][-3:] == ["reach", "grasp", "withdraw"]
    assert phases[0]["begin"] == 0.0
    assert all(a["end"] == b["begin"] for a, b in pairwise(phases))
    assert phases[-1]["end"] == grasp["duration"]


@pytest.mark.needs_mujoco
def test_the_table_has_every_sample(episode: Episode) -> None:
    rows = list(csv.DictReader(io.StringIO(as_csv(joint_trajectories(episode, ARM)))))
    driven = [step.trajectory for step in episode.steps if isinstance(step.trajectory, JointTrajectory)]
    assert len(rows) == sum(len(each.times) for each in driven)
    assert [float(row["yaw"]) for row in rows] == [q for each in driven for q in each.positions[:, 2].tolist()]
    assert [float(row["x_velocity"]) for row in rows] == [v for each in driven for v in each.velocities[:, 0].tolist()]
    assert [float(row["opening"]) for row in rows] == [o for each in driven for o in each.gripper.openings.tolist()]
    assert {row["phase"] for row in rows} >= {"approach", "insert", "sweep", "retreat", "grasp", "withdraw"}


@pytest.mark.needs_mujoco
def test_what_does_not_fit_is_refused(episode: Episode) -> None:
    with pytest.raises(InputError, match=f"actions 1 to {len(episode.steps)}"):
        joint_trajectories(episode, ARM, len(episode.steps) + 1)
    step = episode.steps[0]
    driven = step.trajectory
    assert isinstance(driven, JointTrajectory)
    other = replace(driven, positions=driven.positions[:, :2], velocities=driven.velocities[:, :2])
    with pytest.raises(InputError, match="drives 2 joints"):
        joint_trajectories(replace(episode, steps=(replace(step, trajectory=other),)), ARM)


def test_an_episode_without_joints_says_what_to_do() -> None:
    with pytest.raises(InputError, match=r"no joint trajectories.*--backend mujoco"):
        joint_trajectories(solve("vieira/simple-03"), ARM)
    nothing = solve("vieira/basic", options={"planner": {"max_actions": 1}})
    with pytest.raises(InputError, match="no action was carried out"):
        joint_trajectories(nothing, ARM)
