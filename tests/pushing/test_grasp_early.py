"""With ``grasp_first`` the target is taken past the obstacles that are still in the corridor, where that works."""

from __future__ import annotations

from dataclasses import replace

from phframe.core import Action, ActionKind, ArmState, Motion, State, Status, Transition
from phframe.pushing import Deviation
from tests.pushing.parts import scene_of
from tests.pushing.test_clearing import BLOCKED, aside, grasped, plan

ASIDE = scene_of((0.45, 0.3), (0.2, 0.4))
"""An obstacle in the corridor that keeps no arm from the target."""


def slips(state: State, action: Action) -> Transition:
    """Grasps fail while the obstacle is where it was; pushes work."""
    if action.kind is ActionKind.GRASP and state.positions[1, 1] < 0.45:
        return Transition(state, Motion(1.0))
    return aside(state, action)


def test_nothing_is_pushed_where_the_grasp_is_free() -> None:
    found = plan(ASIDE, aside, grasp_first=True)
    assert (found.status, [action.kind for action in found.actions]) == (Status.RETRIEVED, [ActionKind.GRASP])
    assert found.deviations[Deviation.GRASP_EARLY] == 1
    assert [action.kind for action in plan(ASIDE, aside).actions] == [ActionKind.PUSH, ActionKind.GRASP]


def test_a_grasp_that_fails_is_kept_closed_and_the_pushes_go_on() -> None:
    found = plan(ASIDE, slips, grasp_first=True)
    assert (found.status, len(found.actions)) == (Status.RETRIEVED, 2)
    assert not found.deviations[Deviation.GRASP_EARLY]
    assert found.tree is not None
    [failed] = [node for node in found.tree.nodes if node.closed]
    assert (failed.parent, failed.closed) == (0, "the target was not held")
    assert found.cost.simulated_actions == 3


def test_a_grasp_that_is_blocked_is_not_simulated() -> None:
    found = plan(BLOCKED, aside, grasp_first=True)
    assert [action.kind for action in found.actions] == [ActionKind.PUSH, ActionKind.GRASP]
    assert found.cost.simulated_actions == 2


def test_a_grasp_that_loses_the_target_ends_nothing() -> None:
    """What a failed attempt would do is not done: the plan goes on from before it."""

    def answer(state: State, action: Action) -> Transition:
        if action.kind is ActionKind.GRASP and state == ASIDE.initial_state():
            held = replace(state, held="o0", arm=ArmState(action.path.poses[-1], 0.06))
            return Transition(held, Motion(1.0))
        return grasped(state, action) if action.kind is ActionKind.GRASP else aside(state, action)

    found = plan(ASIDE, answer, grasp_first=True)
    assert (found.status, len(found.actions)) == (Status.RETRIEVED, 2)
