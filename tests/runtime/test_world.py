"""A world drives an arm to an action's beginning, along it, and out again after a stall."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.drive import SATURATED
from phframe.core import (
    Action,
    BasePose,
    Contacts,
    GripperPath,
    GripperTrajectory,
    IncompatibleError,
    OptionError,
    Phase,
    PhaseRule,
    State,
    Stop,
    StopCause,
    UnknownNameError,
    Watch,
)
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import World, WorldSpec
from tests.pushing.parts import ARM, boundary, posed, scene_of
from tests.runtime.worlds import BASIC

WALL = scene_of((0.5, 0.1), *[(0.24 + 0.06 * i, 0.6 - 0.03 - 0.06 * k) for i in range(3) for k in range(6)])
"""Three rows of six against the north wall: nothing can be pushed farther north."""


def push(*tips: tuple[float, float], yaw: float = 0.0) -> Action:
    """In, across and out through fingertip positions."""
    rule = PhaseRule(0.25, 0.0, Contacts.OBJECTS)
    poses = np.array([(x, y, yaw) for x, y in tips])
    phases = (Phase.INSERT, Phase.SWEEP, Phase.RETREAT)
    return Action("push", GripperPath(poses, phases, dict.fromkeys(phases, rule)))


JAM = push((-0.05, 0.2), (0.3, 0.2), (0.3, 0.5), (-0.05, 0.5))
TILTED_JAM = push((-0.15, 0.1), (0.3, 0.19), (0.28, 0.5), (-0.15, 0.4), yaw=0.2)


def foremost(state: State) -> float:
    assert state.arm is not None
    return float(posed(boundary(ARM.closed), *state.arm.gripper)[:, 0].max())


@pytest.mark.parametrize("action", [JAM, TILTED_JAM], ids=["straight", "tilted"])
def test_after_a_stall_the_arm_is_outside_and_the_objects_are_in_place(action: Action) -> None:
    with PlanningWorld(WorldSpec(WALL)) as world:
        start = WALL.initial_state()
        transition = world.apply(start, action)
        after, motion = transition.state, transition.motion
        assert (motion.stalled, motion.complete) == (True, False)
        assert motion.largest_force > 30.0
        assert foremost(after) <= 1e-3, "the whole arm is before the mouth"
        assert after.on_board.all()
        assert (after.positions[:, 1] <= 0.6 - 0.03 + 2e-3).all(), "nothing is squeezed into the wall"
        frames: list[tuple[float, State]] = []
        assert (
            world.apply(start, action, watch=Watch(1 / 30, lambda time, state: frames.append((time, state))))
            == transition
        )
        times = [time for time, _ in frames]
        assert times == sorted(times)
        assert times[-1] == pytest.approx(motion.duration)
        assert frames[-1][1] == after


def test_the_world_goes_on_after_a_stall() -> None:
    with ExecutionWorld(WorldSpec(WALL)) as world:
        state = world.start()
        for action in (JAM, push((-0.05, 0.1), (0.2, 0.1), (0.2, 0.15), (-0.05, 0.15))):
            trajectory = world.plan_trajectory(state, action)
            assert isinstance(trajectory, GripperTrajectory)
            motion = world.execute(trajectory)
            state = world.observe()
            assert foremost(state) <= 1e-3
        assert not motion.stalled


def test_from_parked_the_arm_comes_from_home_and_then_from_where_it_is() -> None:
    with ExecutionWorld(WorldSpec(BASIC)) as world:
        parked = world.start()
        assert parked.arm is None
        easy = push((-0.05, 0.1), (0.05, 0.1), (0.05, 0.12), (-0.05, 0.12))
        trajectory = world.plan_trajectory(parked, easy)
        assert isinstance(trajectory, GripperTrajectory)
        np.testing.assert_allclose(trajectory.poses[0], [-0.1, BASIC.shelf.width / 2, 0.0])
        np.testing.assert_array_equal(trajectory.poses[1:], easy.path.poses)
        assert trajectory.phases == (Phase.APPROACH, *easy.path.phases)
        assert trajectory.force_limit == world.arm.force_limit
        world.execute(trajectory)
        later = world.plan_trajectory(world.observe(), easy)
        assert isinstance(later, GripperTrajectory)
        np.testing.assert_allclose(later.poses[0], trajectory.poses[-1], atol=2e-3)


def test_an_action_that_begins_where_the_arm_is_needs_no_approach() -> None:
    with PlanningWorld(WorldSpec(BASIC)) as world:
        state = world.apply(BASIC.initial_state(), push((-0.05, 0.1), (0.0, 0.1), (0.0, 0.1), (-0.05, 0.1))).state
        assert state.arm is not None
        action = push(
            tuple(state.arm.gripper[:2]), (0.0, 0.1), (0.0, 0.12), (-0.05, 0.12), yaw=float(state.arm.gripper[2])
        )
        trajectory = world.plan_trajectory(state, action)
        assert isinstance(trajectory, GripperTrajectory)
        assert trajectory.phases == action.path.phases


def test_the_scenes_base_pose_counts_before_the_arms_own() -> None:
    mounted = replace(BASIC, base_poses={"planar": BasePose(-0.3, 0.1, 0.06, 0.0)})
    with PlanningWorld(WorldSpec(mounted)) as world:
        trajectory = world.plan_trajectory(mounted.initial_state(), JAM)
        assert isinstance(trajectory, GripperTrajectory)
        np.testing.assert_allclose(trajectory.poses[0], [-0.3, 0.1, 0.0])
        assert world.apply(mounted.initial_state(), JAM).motion.duration > 0.0


@pytest.mark.parametrize(
    ("spec", "error"),
    [
        (WorldSpec(BASIC, backend="pymunkk"), UnknownNameError),
        (WorldSpec(BASIC, arm="planer"), UnknownNameError),
        (WorldSpec(BASIC, backend_options={"stepp": 1}), OptionError),
        (WorldSpec(BASIC, arm_options={"link_width": -1}), OptionError),
    ],
)
def test_what_cannot_be_built_is_refused(spec: WorldSpec, error: type[Exception]) -> None:
    with pytest.raises(error):
        PlanningWorld(spec)


def test_a_backend_that_drives_joints_needs_a_motion_planner(monkeypatch: pytest.MonkeyPatch) -> None:
    from phframe.backends.pymunk_.physics import PymunkPhysics
    from phframe.core import JointTrajectory

    class Immovable(PlanarArm):
        motion_planner: Any = None

    monkeypatch.setattr(PymunkPhysics, "executes", JointTrajectory)
    with pytest.raises(IncompatibleError, match="no motion planner"):
        PlanningWorld(WorldSpec(BASIC, arm=Immovable))


SERVING = """
from phframe.arms.planar import PlanarArm
from phframe.motion.reachability import reachability

class Serving(PlanarArm):
    def fraction_served(self, shelf, base_pose, enough=1.0):
        return reachability(shelf, self, base_pose).fraction
"""


@pytest.mark.needs_mujoco
def test_a_base_pose_that_cannot_serve_the_shelf_is_refused_where_joints_are_driven(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    (tmp_path / "serving.py").write_text(SERVING)
    arm = f"{tmp_path / 'serving.py'}:Serving"
    low = replace(BASIC, base_poses={arm: BasePose(-0.1, 0.3, 0.02, 0.0)})  # its plane is not the gripper's
    with pytest.raises(IncompatibleError, match=r"reaches 0% of the shelf, and 70% is the least.*phframe arm reach"):
        ExecutionWorld(WorldSpec(low, "mujoco", arm))
    ExecutionWorld(WorldSpec(low, "pymunk", arm)).close()
    ExecutionWorld(WorldSpec(BASIC, "mujoco", arm)).close()


def test_worlds_can_be_closed_twice_and_are_by_with() -> None:
    world = World(WorldSpec(scene_of((0.4, 0.3))))
    with world:
        pass
    world.close()


@pytest.mark.parametrize("arm", [PlanarArm, PlanarArm(PlanarArmOptions(link_width=0.05))], ids=["class", "object"])
def test_a_registered_arm_given_as_it_is_stands_where_the_scene_has_its_name(arm: Any) -> None:
    mounted = replace(BASIC, base_poses={"planar": BasePose(-0.3, 0.1, 0.06, 0.0)})
    with PlanningWorld(WorldSpec(mounted, arm=arm)) as world:
        assert world.base_pose == mounted.base_poses["planar"]


def test_an_arm_that_cannot_be_hashed_and_is_not_registered_stands_where_it_does_by_default() -> None:
    class Unhashable(PlanarArm):
        __hash__ = None  # type: ignore[assignment]

    mounted = replace(BASIC, base_poses={"planar": BasePose(-0.3, 0.1, 0.06, 0.0)})
    with PlanningWorld(WorldSpec(mounted, arm=Unhashable(PlanarArmOptions()))) as world:
        assert world.base_pose == world.arm.default_base_pose(BASIC.shelf)


def test_of_a_stop_and_a_stall_in_the_same_step_the_stop_counts() -> None:
    fast = PhaseRule(2.0, 0.0, Contacts.OBJECTS)
    phases = JAM.path.phases
    action = replace(JAM, path=replace(JAM.path, rules=dict.fromkeys(phases, fast)))
    with PlanningWorld(WorldSpec(WALL)) as world:
        start = WALL.initial_state()
        assert world.apply(start, action).motion.stalled
        motion = world.apply(start, action, Stop(force=world.arm.force_limit * SATURATED - 0.01)).motion
        assert motion.stopped is not None
        assert (motion.stopped.cause, motion.stalled) == (StopCause.FORCE, False)
