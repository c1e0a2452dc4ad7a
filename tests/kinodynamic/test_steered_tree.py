"""Where steering leads is kept as it was: nothing is simulated twice, and what must not happen closes a branch."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from phframe.core import (
    Action,
    Budget,
    BudgetExceededError,
    Condition,
    Contacts,
    Phase,
    PhaseRule,
    Scene,
    Task,
    controlled_path,
)
from phframe.kinodynamic.steered_tree import Controls, Room, SteeredTree
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of

SCENE = scene_of((0.4, 0.3), (0.1, 0.3))
ROOM = Room(np.array([-0.15, 0.0, -0.7]), np.array([0.6, 0.6, 0.7]))
AHEAD = np.array([0.1, 0.0, 0.0])


@pytest.fixture
def world() -> Iterator[PlanningWorld]:
    with PlanningWorld(WorldSpec(SCENE)) as made:
        yield made


def task_of(world: PlanningWorld, scene: Scene = SCENE, simulations: int | None = None) -> Task:
    topology, goal = create(Kind.TOPOLOGY, "ripser"), create(Kind.GOAL, "retrieve")
    rng, budget = np.random.default_rng(0), Budget(simulations=simulations)
    return world.task(scene.initial_state(), topology, rng, goal=goal, budget=budget)


def tree_in(task: Task, room: Room = ROOM, controls: Controls = Controls()) -> SteeredTree:  # noqa: B008 - immutable
    assert task.steering is not None
    return SteeredTree(task.steering, task.steering.begin(task.start), controls, room, task.arm.min_opening)


def test_controls_lead_from_any_node_on_and_are_told(world: PlanningWorld) -> None:
    tree, aside = tree_in(task_of(world)), np.array([0.0, 0.05, 0.02])
    one = tree.extend(0, AHEAD)
    other = tree.extend(0, aside)
    deep = tree.extend(one, aside)
    assert (tree.branch(deep), tree.tried) == ([0, one, deep], 3)
    np.testing.assert_array_equal(tree.twists(deep), [AHEAD, aside])
    assert tree.twists(0).shape == (0, 3)
    np.testing.assert_allclose(tree[deep].pose, tree[0].pose + AHEAD + aside, atol=2e-3)
    np.testing.assert_allclose(tree[other].pose, tree[0].pose + aside, atol=2e-3)


def test_the_motion_of_a_branch_is_that_of_its_controls(world: PlanningWorld) -> None:
    tree = tree_in(task_of(world))
    first = tree.extend(0, AHEAD)
    second = tree.extend(first, AHEAD)
    third = tree.extend(second, AHEAD)
    assert tree.motion(0).duration == 0.0
    assert tree.motion(third).duration == pytest.approx(3.0, abs=0.02)
    assert {contact.body for contact in tree.motion(third).contacts} == {"o0"}
    assert not tree.motion(first).contacts


def test_what_leads_out_of_the_room_is_not_simulated(world: PlanningWorld) -> None:
    task = task_of(world)
    tree = tree_in(task, Room(np.array([-0.15, 0.2, -0.7]), np.array([0.6, 0.35, 0.7])))
    out = tree.extend(0, np.array([0.0, 0.1, 0.0]))
    assert "room" in tree[out].fault
    assert tree[out].state == tree[0].state
    assert (tree.tried, task.cost.simulated_actions) == (1, 0)


def test_a_wall_closes_a_branch(world: PlanningWorld) -> None:
    beyond = Room(np.array([-0.15, -1.0, -0.7]), np.array([0.9, 0.6, 0.7]))
    tree, node = tree_in(task_of(world), beyond, Controls(speed=0.3)), 0
    for twist in ([0.0, -0.24, 0.0], [0.25, 0.0, 0.0], [0.0, -0.2, 0.0]):
        node = tree.extend(node, np.array(twist))
    assert "south wall" in tree[node].fault


def test_what_falls_closes_a_branch(world: PlanningWorld) -> None:
    """An object at the very mouth, in the angle between the board's edge and the turned arm, is pushed off the board."""
    task, row = task_of(world), SCENE.index("o0")
    poses = task.start.poses.copy()
    poses[row, :2] = 0.005, 0.3
    assert task.steering is not None
    begin = task.steering.begin(replace(task.start, poses=poses))
    tree, node = SteeredTree(task.steering, begin, Controls(0.3, 0.7), ROOM, task.arm.min_opening), 0
    for twist in ([0.15, -0.1, 0.0], [0.05, 0.05, 0.5], [0.0, 0.06, 0.0]):
        assert not tree[node].fault
        node = tree.extend(node, np.array(twist))
    assert tree[node].state.conditions[row] is Condition.SPILLED
    assert tree[node].fault == "something spilled"


def test_the_budget_counts_controls(world: PlanningWorld) -> None:
    task = task_of(world, simulations=2)
    tree = tree_in(task)
    tree.extend(0, AHEAD)
    tree.extend(0, AHEAD)
    with pytest.raises(BudgetExceededError):
        tree.extend(0, AHEAD)
    assert task.cost.simulated_actions == 2


def test_a_branch_driven_as_a_path_ends_where_it_was_steered_to(world: PlanningWorld) -> None:
    task = task_of(world)
    tree, node = tree_in(task), 0
    for twist in ([0.1, 0.02, 0.0], [0.1, -0.03, 0.1], [0.08, 0.0, -0.05]):
        node = tree.extend(node, np.array(twist))
    rule = PhaseRule(0.1, task.arm.min_opening, Contacts.OBJECTS)
    path = controlled_path(tree[0].pose, tree.twists(node), 1.0, Phase.SWEEP, rule)
    made = task.apply(task.start, Action("steered", path)).state
    assert made.arm is not None
    np.testing.assert_allclose(made.arm.gripper, tree[node].pose, atol=2e-3)
    np.testing.assert_allclose(made.positions, tree[node].state.positions, atol=5e-3)
    assert tree[node].state.displacement(task.start)[SCENE.index("o0")] > 0.02
