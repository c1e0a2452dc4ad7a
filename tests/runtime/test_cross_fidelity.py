"""Plans made in one world and carried out in another, more real one."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import phframe
from phframe.arms.planar import PlanarArm
from phframe.core import IncompatibleError, JointTrajectory, OptionError, RunSpec, Scene, Status, Step
from phframe.runtime.observer import Frames, MountedArm, Observer
from phframe.runtime.plan_backend import default_plan_backend
from phframe.runtime.scenes import find_scene
from phframe.runtime.summary import summarize
from phframe.runtime.world import World, WorldSpec

pytest.importorskip("mujoco")
pytestmark = pytest.mark.needs_mujoco

SCENE = "papallas/s02"
IN_PLANE = default_plan_backend()


def test_it_plans_in_the_plane_and_drives_joints_in_mujoco(tmp_path: Path) -> None:
    episode = phframe.solve(SCENE, backend="mujoco")
    assert episode.status is Status.RETRIEVED
    assert (episode.spec.backend, episode.spec.plan_backend, episode.spec.plan_arm) == ("mujoco", IN_PLANE, "planar")
    assert all(isinstance(step.trajectory, JointTrajectory) for step in episode.steps)
    summary = summarize(episode)
    assert (summary["plan_backend"], summary["plan_arm"]) == (IN_PLANE, "planar")
    assert {"numba" if IN_PLANE == "fast" else "pymunk", "mujoco"} <= set(summary["versions"])
    assert 0.0 < summary["motion_planning_time"] < 1.0
    assert 0.0 < summary["tracking_error"] < 0.01
    error = summary["prediction_error"]
    assert 0.0 < error["median"] <= error["worst"] < 0.1
    phframe.save(episode, tmp_path / "episode.json")
    assert phframe.load(tmp_path / "episode.json") == episode


def test_the_same_seed_gives_the_same_episode() -> None:
    one, two = (phframe.solve(SCENE, backend="mujoco") for _ in range(2))
    assert one.steps == two.steps
    assert one == two


def test_it_can_plan_in_mujoco_too_with_options_of_its_own() -> None:
    episode = phframe.solve(
        SCENE,
        backend="mujoco",
        plan_backend="mujoco",
        options={"plan_backend": {"step": 0.004}, "backend": {"sleep": False}},
    )
    assert episode.spec.plan_backend == "mujoco"
    assert episode.spec.options["backend"] == {"sleep": False}
    assert episode.spec.options["plan_backend"] == {"sleep": False, "step": 0.004}
    assert episode.status is Status.RETRIEVED


def test_in_pymunk_planning_and_execution_are_one_world() -> None:
    episode = phframe.solve("vieira/simple-03")
    summary = summarize(episode)
    assert (summary["plan_backend"], summary["plan_arm"]) == ("pymunk", "planar")
    assert summary["motion_planning_time"] == 0.0
    assert episode.spec.plan_backend == "pymunk"


def test_prediction_errors_are_those_of_what_moved() -> None:
    episode = phframe.solve(SCENE, backend="mujoco")
    expected = []
    for step in episode.steps:
        if step.expected is None:
            continue
        for row in range(len(episode.scene.objects)):
            before, after, wanted = (state.poses[row, :3] for state in (step.before, step.after, step.expected))
            if max(np.linalg.norm(after - before), np.linalg.norm(wanted - before)) > 1e-3:
                expected.append(np.linalg.norm(after - wanted))
    assert episode.prediction_errors.tolist() == pytest.approx(expected)


def test_an_arm_without_a_motion_planner_is_refused_in_one_line() -> None:
    class Immovable(PlanarArm):
        motion_planner: Any = None

    with pytest.raises(IncompatibleError, match="Immovable has no motion planner") as found:
        World(WorldSpec(find_scene(SCENE), backend="mujoco", arm=Immovable))
    assert "\n" not in str(found.value)
    World(WorldSpec(find_scene(SCENE), arm=Immovable)).close()


def test_options_of_what_is_not_there_are_refused() -> None:
    with pytest.raises(OptionError, match="plan_backend"):
        phframe.solve(SCENE, options={"plan_physics": {}})
    with pytest.raises(OptionError, match="has no option 'stepp'"):
        phframe.solve(SCENE, backend="mujoco", options={"plan_backend": {"stepp": 1}})


def test_observers_are_told_of_the_joints_and_frames_end_where_the_action_did() -> None:
    class Looking(Observer):
        arms: ClassVar[list[MountedArm]] = []

        def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
            self.arms.append(arm)

        def stepped(self, step: Step, frames: Frames) -> None:
            states = [state for _, state in frames]
            joints = [state.arm is not None and state.arm.joints is not None for state in states[1:]]
            assert set(joints) == {self.arms[-1].by_joints}
            assert states[-1] == step.after

    looked_at = phframe.solve("vieira/simple-03", backend="mujoco", observers=[Looking()])
    assert looked_at == phframe.solve("vieira/simple-03", backend="mujoco")
    phframe.solve("vieira/simple-03", observers=[Looking()])
    assert [arm.by_joints for arm in Looking.arms] == [True, False]
    assert Looking.arms[0].base_pose == Looking.arms[0].model.default_base_pose(find_scene("vieira/simple-03").shelf)
