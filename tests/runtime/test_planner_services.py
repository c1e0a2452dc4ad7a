"""What a task offers besides applying whole actions: ending early, steering, whether the arm can do it at all."""

from __future__ import annotations

import numpy as np
import pytest

from phframe.core import (
    Action,
    Budget,
    BudgetExceededError,
    Contacts,
    GripperPath,
    Phase,
    PhaseRule,
    Stop,
    StopCause,
    Task,
    controlled_path,
)
from phframe.registry import Kind, create
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of

SCENE = scene_of((0.4, 0.3), (0.2, 0.3))
RULE = PhaseRule(0.2, 0.0, Contacts.OBJECTS)
ENGINES = [
    "pymunk",
    pytest.param("mujoco", marks=pytest.mark.needs_mujoco),
    pytest.param("pybullet", marks=pytest.mark.needs_pybullet),
]


def task_in(world: PlanningWorld, budget: Budget = Budget(), execution: ExecutionWorld | None = None) -> Task:  # noqa: B008
    topology, goal = create(Kind.TOPOLOGY, "ripser"), create(Kind.GOAL, "retrieve")
    reach = None if execution is None else execution.unreachable
    rng = np.random.default_rng(0)
    return world.task(SCENE.initial_state(), topology, rng, goal=goal, budget=budget, reach=reach)


def straight_in(depth: float, y: float = 0.3) -> Action:
    poses = np.array([[-0.1, y, 0.0], [depth, y, 0.0]])
    return Action("in", GripperPath(poses, (Phase.INSERT,), {Phase.INSERT: RULE}))


@pytest.mark.parametrize("backend", ENGINES)
def test_a_drive_ends_at_the_first_contact_that_was_asked_for_and_stands_there(backend: str) -> None:
    pytest.importorskip(backend)
    with PlanningWorld(WorldSpec(SCENE, backend)) as world:
        task = task_in(world)
        made = task.apply(task.start, straight_in(0.38), stop=Stop(bodies=frozenset({"o0", "target"})))
        stopped = made.motion.stopped
        assert stopped is not None
        assert (stopped.cause, stopped.body) == (StopCause.CONTACT, "o0")
        assert made.state.arm is not None
        assert made.state.arm.gripper[0] == pytest.approx(0.17, abs=0.02), "at the blocker, and not drawn back"
        assert task.apply_many([(task.start, straight_in(0.38))], stop=Stop(bodies=frozenset({"o0"})))[0].motion.stopped


@pytest.mark.parametrize("backend", ENGINES)
def test_steering_from_a_parked_arm_is_pure_and_counts(backend: str) -> None:
    pytest.importorskip(backend)
    with PlanningWorld(WorldSpec(SCENE, backend)) as world:
        task = task_in(world, Budget(simulations=4))
        steering = task.steering
        assert steering is not None
        begin = steering.begin(task.start, [-0.05, 0.3, 0.0])
        twist = [0.1, 0.0, 0.0]
        first, motion = steering.propagate(begin, twist, 1.0)
        again, _ = steering.propagate(begin, twist, 1.0)
        assert steering.state_of(first) == steering.state_of(again)
        arm = steering.state_of(first).arm
        assert arm is not None
        assert arm.gripper[0] == pytest.approx(0.05, abs=5e-3)
        assert motion.duration == pytest.approx(1.0, abs=0.01)
        for _ in range(2):
            first, _ = steering.propagate(first, twist, 1.0)
        assert task.cost.simulated_actions == 4
        pushed = steering.state_of(first).displacement(task.start)[SCENE.index("o0")]
        assert pushed > 0.05, "the arm went on through where the obstacle stood"
        with pytest.raises(BudgetExceededError):
            steering.propagate(first, twist, 1.0)


def test_controls_that_were_steered_can_be_carried_out_as_an_action() -> None:
    twists = np.array([[0.1, 0.0, 0.0], [0.03, 0.02, 0.0], [0.05, 0.0, 0.05]])
    with PlanningWorld(WorldSpec(SCENE, "pymunk")) as world:
        task = task_in(world)
        assert task.steering is not None
        snapshot = task.steering.begin(task.start, [0.0, 0.3, 0.0])
        for twist in twists:
            snapshot, _ = task.steering.propagate(snapshot, twist, 1.0)
        steered = task.steering.state_of(snapshot).arm
        path = controlled_path([0.0, 0.3, 0.0], twists, 1.0, Phase.SWEEP, RULE)
        applied = task.apply(task.start, Action("steered", path)).state.arm
    assert steered is not None
    assert applied is not None
    np.testing.assert_allclose(steered.gripper, applied.gripper, atol=2e-3)


def test_an_action_beyond_the_arm_that_will_execute_is_told_before_it_is_tried() -> None:
    with PlanningWorld(WorldSpec(SCENE)) as planning, ExecutionWorld(WorldSpec(SCENE)) as execution:
        task = task_in(planning, execution=execution)
        assert task.reachable(straight_in(0.2)) is None
        beyond = task.reachable(straight_in(0.2, y=9.0))
        assert beyond is not None
        assert "does not reach" in beyond.why
        assert task.cost.motion_planning > 0.0
        assert task.cost.simulated_actions == 0
        assert task_in(planning).reachable(straight_in(0.2, y=9.0)) is None, "nobody knows who will execute"
