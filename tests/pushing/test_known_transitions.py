"""What an earlier tree knows: every transition in it, from the very same state only, and the push that was to come next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    ArmState,
    Condition,
    Contacts,
    Decision,
    GripperPath,
    Motion,
    Phase,
    PhaseRule,
    SearchTree,
    State,
    Transition,
)
from phframe.planners.sure import Sure, SureOptions
from phframe.pushing import KnownTransitions, PushDecision
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import often, scene_of
from tests.pushing.worlds import task_in

SCENE = scene_of((0.45, 0.3), (0.2, 0.3))


def state(number: int) -> State:
    poses = SCENE.initial_state().poses.copy()
    poses[1, 1] += 0.01 * number
    return State(poses, (Condition.UPRIGHT, Condition.UPRIGHT))


def action(number: int) -> Action:
    poses = np.array([[-0.1, 0.01 * number, 0.0], [0.1, 0.01 * number, 0.0]])
    return Action(
        f"a{number}",
        GripperPath(poses, (Phase.INSERT,), {Phase.INSERT: PhaseRule(0.2, 0.0, Contacts.OBJECTS)}),
        ("o0",),
    )


@often
@given(st.lists(st.integers(0, 100), min_size=1, max_size=15), st.data())
def test_it_knows_each_transition_of_a_tree_and_none_from_another_state(
    parents: list[int], data: st.DataObject
) -> None:
    tree = SearchTree(state(0))
    for number, parent in enumerate(parents, start=1):
        tree.child(parent % number, action(number), Transition(state(number), Motion(float(number))))
    chosen = data.draw(st.integers(0, len(parents)))
    known = KnownTransitions(tree.explored(chosen))
    for number, parent in enumerate(parents, start=1):
        assert known.of(state(parent % number), action(number)) == Transition(state(number), Motion(float(number)))
        assert known.of(state(number), action(number)) is None
        assert known.of(state(parent % number), action(number + 1000)) is None
    path = tree.path(chosen)
    assert (known.still_to_do is None) is (not path)
    if path:
        assert known.still_to_do is not None
        assert known.still_to_do[1] == path[0].action


def test_nothing_is_known_without_a_tree_or_of_a_root() -> None:
    for known in (KnownTransitions(None), KnownTransitions(SearchTree(state(0)).explored(ROOT))):
        assert known.of(state(0), action(0)) is None
        assert known.still_to_do is None


def test_a_state_of_other_poses_or_conditions_is_another() -> None:
    tree = SearchTree(state(0))
    tree.child(ROOT, action(1), Transition(state(1), Motion(1.0)))
    known = KnownTransitions(tree.explored(1))
    start = state(0)
    assert known.of(start, action(1)) is not None
    poses = start.poses.copy()
    poses[1, 0] = np.nextafter(poses[1, 0], 1.0)
    assert known.of(replace(start, poses=poses), action(1)) is None
    assert known.of(replace(start, conditions=(Condition.UPRIGHT, Condition.TOPPLED)), action(1)) is None


def test_what_another_engine_made_of_a_state_is_not_known() -> None:
    tree = SearchTree(state(0))
    tree.child(ROOT, action(1), Transition(state(1), Motion(1.0)), PushDecision(confirmed=True))
    assert KnownTransitions(tree.explored(1)).of(state(0), action(1)) is None


def test_a_state_whose_arm_stands_elsewhere_is_another() -> None:
    standing = replace(state(0), arm=ArmState(np.array([-0.2, 0.3, 0.0]), 0.0))
    tree = SearchTree(standing)
    tree.child(ROOT, action(1), Transition(state(1), Motion(1.0)))
    known = KnownTransitions(tree.explored(1))
    assert known.of(standing, action(1)) is not None
    assert known.of(state(0), action(1)) is None


def test_a_grasp_is_not_still_to_be_done_but_known() -> None:
    """It is looked for anew where the target is now."""
    tree = SearchTree(state(0))
    legs = (Phase.REACH, Phase.GRASP)
    rules = {leg: PhaseRule(0.2, 0.0, Contacts.MANIPULAND) for leg in legs}
    path = GripperPath(np.array([[-0.1, 0.3, 0.0], [0.4, 0.3, 0.0], [0.4, 0.3, 0.0]]), legs, rules, "target")
    grasp = Action("grasp", path, ("target",), ActionKind.GRASP)
    tree.child(ROOT, grasp, Transition(state(0), Motion(1.0)), Decision())
    known = KnownTransitions(tree.explored(1))
    assert known.still_to_do is None
    assert known.of(state(0), grasp) is not None


def test_what_a_plan_knew_is_what_the_engine_makes_of_it() -> None:
    scene = scene_of((0.45, 0.3), (0.25, 0.3), (0.25, 0.365), (0.25, 0.235), (0.3, 0.17), (0.3, 0.43))
    with PlanningWorld(WorldSpec(scene)) as world:
        plan = Sure(SureOptions()).plan(task_in(world))
        assert plan.tree is not None
        known, pushes = KnownTransitions(plan.tree), 0
        for node in plan.tree.nodes[1:]:
            assert node.action is not None
            before = plan.tree.nodes[node.parent or ROOT].state
            made = known.of(before, node.action)
            assert made is not None
            assert made == world.apply(before, node.action)
            pushes += 1
        assert pushes >= 2
