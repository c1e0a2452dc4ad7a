"""Baxter clears a shelf in MuJoCo, and what it cannot do is refused before anything moves."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("mujoco")
pytest.importorskip("pinocchio")
pytest.importorskip("ompl")

import phframe
from phframe.core import Episode, InputError, JointTrajectory, Phase, Status
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.summary import summarize
from phframe.runtime.world import WorldSpec
from tests.cli.conftest import Invoke, invoke, workplace

__all__ = ["invoke", "workplace"]

pytestmark = [pytest.mark.needs_mujoco, pytest.mark.needs_baxter, pytest.mark.needs_ompl]

SCENE = "vieira/simple-10"


@pytest.fixture(scope="module")
def episode() -> Episode:
    return phframe.solve(SCENE, backend="mujoco", arm="baxter")


def test_it_pushes_grasps_and_draws_out_with_joints_alone(episode: Episode) -> None:
    assert episode.status is Status.RETRIEVED
    summary = summarize(episode)
    assert summary["clean"]
    assert not summary["wall_contact"]
    assert summary["actions"] >= 1
    assert 0.0 < summary["motion_planning_time"] < 10.0
    assert 0.0 < summary["tracking_error"] < 0.01
    for step in episode.steps:
        assert isinstance(step.trajectory, JointTrajectory)
        assert step.trajectory.positions.shape[1] == 7
    assert Phase.WITHDRAW in episode.steps[-1].trajectory.gripper.phases  # type: ignore[union-attr]


def test_a_second_run_gives_the_same_bits(episode: Episode) -> None:
    again = phframe.solve(SCENE, backend="mujoco", arm="baxter")
    assert again.steps == episode.steps
    assert again == episode


@pytest.fixture(scope="module")
def world() -> Iterator[ExecutionWorld]:
    with ExecutionWorld(WorldSpec(find_scene(SCENE), "mujoco", "baxter")) as made:
        yield made


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("position", "'right_w1'.*limits are"),
        ("speed", "'right_w1' at .*limit is 4"),
        ("jump", "from where the arm is"),
    ],
)
def test_a_trajectory_beyond_the_arm_is_refused_before_anything_moves(
    world: ExecutionWorld, episode: Episode, what: str, said: str
) -> None:
    driven: Any = episode.steps[0].trajectory
    before = world.start()
    positions, velocities = driven.positions.copy(), driven.velocities.copy()
    if what == "position":
        positions[-1, 5] = world.arm.joints[5].upper + 0.01
    elif what == "speed":
        velocities[-2, 5] = 1.1 * world.arm.joints[5].velocity
    else:
        positions += 0.05
    bad = replace(driven, positions=positions, velocities=velocities)
    with pytest.raises(InputError, match=said) as caught:
        world.physics.execute(bad, settle=None)
    assert "\n" not in str(caught.value)
    assert world.observe() == before


@pytest.mark.parametrize("array", ["positions", "velocities"])
def test_joints_that_are_no_numbers_make_no_trajectory(episode: Episode, array: str) -> None:
    driven: Any = episode.steps[0].trajectory
    values = getattr(driven, array).copy()
    values[3, 2] = np.nan
    with pytest.raises(InputError, match="not finite"):
        replace(driven, **{array: values})


SOLVE = ("solve", SCENE, "--backend", "mujoco", "--arm", "baxter", "--no-rerun")


def test_an_unknown_motion_planner_is_one_line_with_those_there_are(invoke: Invoke) -> None:
    result = invoke(*SOLVE, "--option", "arm.motion_planner=RTConnect")
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert "Did you mean 'RRTConnect'?" in result.stderr
    assert "BiEST" in result.stderr


@pytest.mark.parametrize(("library", "extra"), [("ompl", "ompl"), ("toppra", "baxter")])
def test_a_missing_library_is_one_line_with_its_extra(
    invoke: Invoke, monkeypatch: pytest.MonkeyPatch, library: str, extra: str
) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == library]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, library, None)
    for name in ("articulated", "time_parametrisation", "toppra_"):
        monkeypatch.delitem(sys.modules, f"phframe.motion.{name}", raising=False)
    result = invoke(*SOLVE)
    assert result.exit_code != 0
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert f'pip install "phframe[{extra}]"' in result.stderr
