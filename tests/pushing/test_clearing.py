"""The loop of PHIA and OOA: what it makes of what the world answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from phframe.core import (
    Action,
    ActionKind,
    ArmState,
    Budget,
    Condition,
    Motion,
    Options,
    Plan,
    Scene,
    State,
    Status,
    StopCause,
    StopReason,
    Task,
    Transition,
)
from phframe.core.explored_tree import ROOT
from phframe.planners.ooa import OOA
from phframe.pushing import ClearingOptions, Deviation, PushDecision, PushProblem, PushSearch
from phframe.topology.single_linkage import SingleLinkage
from tests.pushing.parts import ARM, RETRIEVE, rejections, scene_of

Answer = Callable[[State, Action], Transition]
BLOCKED = scene_of((0.45, 0.3), (0.2, 0.31))
FREE = scene_of((0.45, 0.3))
BESIDE = scene_of((0.45, 0.3), (0.45, 0.3605), (0.45, 0.2395))
"""An empty corridor, and a grasp that is blocked on both sides."""


def task_of(scene: Scene, answer: Answer, rejected: tuple[Action, ...] = ()) -> Task:
    rng, topology = np.random.default_rng(0), SingleLinkage(Options())
    start = scene.initial_state()
    return Task(
        scene=scene,
        start=start,
        goal=RETRIEVE,
        arm=ARM,
        topology=topology,
        apply=lambda state, action, stop: answer(state, action),
        rng=rng,
        rejected=rejections(rejected),
        budget=Budget(20.0),
    )


def plan(scene: Scene, answer: Answer, rejected: tuple[Action, ...] = (), **options: object) -> Plan:
    return OOA(ClearingOptions.parse(options, "ooa")).plan(task_of(scene, answer, rejected))


def moved(state: State, row: int, by: tuple[float, float]) -> State:
    poses = state.poses.copy()
    poses[row, :2] += by
    return replace(state, poses=poses)


def grasped(state: State, action: Action) -> Transition:
    """The target is drawn out."""
    out = replace(moved(state, 0, (-0.6, 0.0)), held="target", arm=ArmState(action.path.poses[-1], 0.06))
    return Transition(out, Motion(1.0))


def stays(state: State, action: Action) -> Transition:
    return grasped(state, action) if action.kind is ActionKind.GRASP else Transition(state, Motion(1.0))


def aside(state: State, action: Action) -> Transition:
    """Every push takes the object it means out of the corridor."""
    if action.kind is ActionKind.GRASP:
        return grasped(state, action)
    return Transition(moved(state, 1, (0.0, 0.15)), Motion(1.0))


def test_pushes_until_the_corridor_is_empty_and_then_grasps() -> None:
    found = plan(BLOCKED, aside)
    assert (found.status, found.reason) == (Status.RETRIEVED, "")
    assert [action.kind for action in found.actions] == [ActionKind.PUSH, ActionKind.GRASP]
    assert found.tree is not None
    assert [node.parent for node in found.tree.path] == [0, 1]
    assert found.expected[-1].held == "target"
    assert PushDecision.of(found.decisions[-1]).corridor == PushDecision.of(found.decisions[0]).corridor


def test_an_empty_corridor_is_left_alone() -> None:
    found = plan(FREE, stays)
    assert [action.name for action in found.actions] == ["grasp target"]


def test_a_push_that_moves_nothing_is_a_failure_after_all_were_tried() -> None:
    tried: list[Action] = []

    def answer(state: State, action: Action) -> Transition:
        tried.append(action)
        return Transition(moved(state, 1, (0.0009, 0.0)), Motion(1.0))

    found = plan(BLOCKED, answer)
    assert (found.status, found.actions) == (Status.FAILED, ())
    assert found.reason == f"nothing moved: {tried[0].name}"
    assert found.tree is not None
    assert [node.closed for node in found.tree.nodes[1:]].count("nothing moved") == len(tried) - 1
    assert len({action.name for action in tried}) == 2
    assert found.cost.simulated_actions == len(tried)


def test_more_than_a_millimetre_is_a_move() -> None:
    found = plan(BLOCKED, lambda state, action: Transition(moved(state, 1, (0.0011, 0.0)), Motion(1.0)), max_actions=4)
    assert (found.status, len(found.actions)) == (Status.FAILED, 4)
    assert found.reason == "the corridor is not empty after 4 actions"


def test_the_first_without_a_penalty_is_taken() -> None:
    """The first proposal stalls, the second does not."""

    def answer(state: State, action: Action) -> Transition:
        tried.append(action)
        return replace(aside(state, action), motion=Motion(1.0, stalled=len(tried) == 1))

    tried: list[Action] = []
    found = plan(BLOCKED, answer)
    assert found.actions[0] == tried[1]
    assert found.actions[0] != tried[0]
    assert Deviation.OTHER_DIRECTION in found.decisions[0].deviations
    assert found.decisions[0].deviations[-1] == Deviation.NEXT_SWEEP


@pytest.mark.parametrize(("first", "taken"), [("spills", 0), ("stalls", 1), ("stays", 1)])
def test_of_several_penalties_a_spill_is_less_than_a_stall_and_that_less_than_nothing_moved(
    first: str, taken: int
) -> None:
    """Whatever the first does, the second stalls or spills: the lesser of the two is kept."""
    tried: list[Action] = []

    def answer(state: State, action: Action) -> Transition:
        if action.kind is ActionKind.GRASP:
            return grasped(state, action)
        tried.append(action)
        there, stalls = moved(state, 1, (0.0, 0.15)), Motion(1.0, stalled=True)
        spilled = Transition(replace(there, conditions=(Condition.UPRIGHT, Condition.SPILLED)), Motion(1.0))
        if len(tried) > 1:
            return Transition(there, stalls) if first != "stalls" else spilled
        return {"spills": spilled, "stalls": Transition(there, stalls), "stays": Transition(state, Motion(1.0))}[first]

    found = plan(BLOCKED, answer)
    assert len(tried) >= 2
    assert found.actions[0] == tried[taken]


@pytest.mark.parametrize(
    ("made", "closed"),
    [
        (Motion(1.0, stalled=True, largest_force=31.4), "stalled at 31 N"),
        (Motion(1.0, stopped=StopReason(StopCause.WALL, "back wall")), "contact with the back wall"),
        (Condition.TOPPLED, "something toppled or spilled"),
        (Condition.SPILLED, "something toppled or spilled"),
    ],
    ids=["stalled", "stopped", "toppled", "spilled"],
)
def test_the_tree_tells_what_was_wrong_with_a_push_that_was_not_taken(made: Motion | Condition, closed: str) -> None:
    tried: list[Action] = []

    def answer(state: State, action: Action) -> Transition:
        tried.append(action)
        done = aside(state, action)
        if len(tried) > 1:
            return done
        if isinstance(made, Motion):
            return replace(done, motion=made)
        return replace(done, state=replace(done.state, conditions=(Condition.UPRIGHT, made)))

    found = plan(BLOCKED, answer)
    assert found.tree is not None
    by_action = {node.action: node.closed for node in found.tree.nodes}
    assert (by_action[tried[0]], by_action[tried[1]]) == (closed, "")
    assert found.actions[0] == tried[1]


def test_a_target_that_is_pushed_off_the_board_ends_it() -> None:
    gone = replace(BLOCKED.initial_state(), conditions=(Condition.SPILLED, Condition.UPRIGHT))
    found = plan(BLOCKED, lambda state, action: Transition(gone, Motion(1.0)))
    assert (found.status, found.reason) == (Status.FAILED, "the target 'target' is spilled")


def test_what_the_grasp_came_to_is_the_status() -> None:
    empty = plan(FREE, lambda state, action: Transition(state, Motion(1.0)))
    assert (empty.status, empty.reason) == (Status.REACHED, "the target was not held")
    stalled = plan(FREE, lambda state, action: Transition(state, Motion(1.0, stalled=True)))
    assert (stalled.status, stalled.reason) == (Status.CLEARED, "the reach stalled: the arm stalled at 0 N")
    assert len(stalled.actions) == len(stalled.expected) == len(stalled.decisions) == 1


def test_what_blocks_the_grasp_is_pushed_once() -> None:
    def answer(state: State, action: Action) -> Transition:
        if action.kind is ActionKind.GRASP:
            return grasped(state, action)
        return Transition(moved(state, BESIDE.index(action.moves[0]), (0.0, 0.1)), Motion(1.0))

    found = plan(BESIDE, answer)
    first = PushDecision.of(found.decisions[0])
    assert first.deviations[0] == Deviation.GRASP_BLOCKED
    assert set(first.members) <= {"o0", "o1"}
    assert found.deviations[Deviation.GRASP_BLOCKED] == 1
    if found.status is Status.FAILED:
        assert found.reason.startswith("grasp blocked by o")


def test_a_grasp_still_blocked_after_that_is_a_failure_that_names_what_is_in_the_way() -> None:
    nudges = iter([(0.0, 0.002), (0.0, -0.002)] * 5)
    found = plan(BESIDE, lambda state, action: Transition(moved(state, 1, next(nudges)), Motion(1.0)))
    assert found.status is Status.FAILED
    assert found.reason.startswith("grasp blocked by o")
    assert len(found.actions) == 1


def test_a_grasp_whose_blockers_cannot_be_moved_is_a_failure_that_names_them() -> None:
    found = plan(BESIDE, stays)
    assert found.status is Status.FAILED
    assert found.reason.startswith("grasp blocked by o")


def test_a_rejected_grasp_is_not_proposed_again() -> None:
    first = plan(FREE, stays).actions[-1]
    again = plan(FREE, stays, rejected=(first,))
    assert first not in again.actions
    assert again.status in (Status.RETRIEVED, Status.FAILED)


def test_rejected_pushes_are_not_proposed_again_until_none_is_left() -> None:
    rejected: tuple[Action, ...] = ()
    for _ in range(12):
        found = plan(BLOCKED, aside, rejected)
        assert not set(found.actions) & set(rejected)
        if not found.actions:
            break
        rejected = (*rejected, found.actions[0])
    told = "no sweep fits beside the closest component (rejected before: it came to nothing)"
    assert (found.status, found.reason) == (Status.FAILED, told)
    assert {action.name for action in rejected} == {"sweep north: o0", "sweep south: o0"}


def test_pushes_that_take_nothing_out_of_the_corridor_are_given_up_after_a_while() -> None:
    found = plan(BLOCKED, lambda state, action: Transition(moved(state, 1, (0.002, 0.0)), Motion(1.0)), patience=3)
    assert found.status is Status.FAILED
    assert len(found.actions) == 4, "the first one met fewer than there are objects in the scene"
    assert found.reason == "the last 3 pushes took nothing out of the corridor"


def test_a_search_gives_up_a_node_where_pushes_took_nothing_out_and_where_there_are_enough() -> None:
    task = task_of(BLOCKED, lambda state, action: Transition(moved(state, 1, (0.002, 0.0)), Motion(1.0)))
    search, node, told = PushSearch(task, ClearingOptions(patience=2, max_actions=3)), ROOT, []
    for _ in range(4):
        problem = search.next_step(node)
        assert isinstance(problem, PushProblem)
        told.append(search.hopeless(node, problem))
        proposals = search.pushing.pushes(problem, search.pushing.diagram(problem), 0.1)
        node = search.try_push(node, *next(proposals))
    given_up = "the last 2 pushes took nothing out of the corridor"
    assert told == ["", "", given_up, "the corridor is not empty after 3 actions"]
