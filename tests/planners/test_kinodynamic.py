"""The kinodynamic planners: they solve what is easy, repeat bit by bit, keep to their budget, and their plans come true."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    Assessment,
    Attempt,
    Budget,
    Condition,
    Motion,
    OptionError,
    Phase,
    Plan,
    Scene,
    Shelf,
    State,
    Status,
    Stop,
    Task,
    Transition,
    Watch,
)
from phframe.kinodynamic.steered_decision import SteeredDecision
from phframe.planners.kinodynamic_rrt import KinodynamicRRTOptions, _Growing
from phframe.pushing import Pushing, PushingOptions, Retrieve, RetrieveOptions, StraightDrive, straight_drive
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of

EASY = scene_of((0.25, 0.3), (0.12, 0.3))
"""One obstacle straight before a target that is not deep in the shelf."""
LONE = scene_of((0.25, 0.3))
LONE_AND_ASIDE = scene_of((0.25, 0.3), (0.25, 0.5))
"""The one obstacle stands where it blocks nothing."""
PLANNERS = [pytest.param("grtc-kinodynamic", marks=pytest.mark.needs_ompl), "kinodynamic-rrt"]
both = pytest.mark.parametrize("planner", PLANNERS)
SEED = 3


def task_in(
    world: PlanningWorld,
    seed: int = SEED,
    simulations: int | None = 3000,
    goal: Retrieve | None = None,
) -> Task:
    topology, goal = create(Kind.TOPOLOGY, "ripser"), goal or create(Kind.GOAL, "retrieve")
    rng, budget = np.random.default_rng(seed), Budget(simulations=simulations)
    return world.task(world.scene.initial_state(), topology, rng, goal=goal, budget=budget)


def planned(
    planner: str, scene: Scene = EASY, seed: int = SEED, simulations: int | None = 3000, **options: object
) -> Plan:
    if planner == "grtc-kinodynamic":
        pytest.importorskip("ompl")
    with PlanningWorld(WorldSpec(scene)) as world:
        plan: Plan = create(Kind.PLANNER, planner, options).plan(task_in(world, seed, simulations))
        return plan


@cache
def usual(planner: str) -> Plan:
    """The plan for the easy scene."""
    return planned(planner)


def short(planner: str, seed: int = SEED) -> Plan:
    """What comes of the easy scene with few simulations: the plan, or how far it got."""
    options: dict[str, object] = {"controls": 60} if planner == "grtc-kinodynamic" else {}
    return planned(planner, EASY, seed, 400, **options)


@pytest.mark.slow
@both
def test_an_easy_scene_is_solved_and_the_plan_comes_true_bit_by_bit(planner: str) -> None:
    plan = usual(planner)
    assert plan.status is Status.RETRIEVED, plan.reason
    assert Counter(action.kind for action in plan.actions)[ActionKind.PUSH] >= 1
    with PlanningWorld(WorldSpec(EASY)) as world:
        state = EASY.initial_state()
        for action, expected in zip(plan.actions, plan.expected, strict=True):
            state = world.apply(state, action).state
            assert state == expected
    assert state.held == "target"


@pytest.mark.slow
@both
def test_the_same_seed_gives_the_same_plan_and_another_seed_another(planner: str) -> None:
    plan = short(planner)
    planned(planner, LONE, seed=5, simulations=30)
    again = short(planner)
    assert again == plan
    assert again.cost.simulated_actions == plan.cost.simulated_actions
    assert short(planner, SEED + 1) != plan


IN_ANOTHER = """
import json, sys
from tests.planners.test_kinodynamic import digest, short
print(json.dumps(digest(short(sys.argv[1]))))
"""


def digest(plan: Plan) -> list[object]:
    """All that a plan says that another process can be asked for."""
    poses = [action.path.poses.tolist() for action in plan.actions]
    return [plan.status, plan.cost.simulated_actions, len(plan.tree.nodes) if plan.tree else 0, poses]


@pytest.mark.slow
@both
def test_two_processes_come_to_the_same_plan(planner: str) -> None:
    plan = short(planner)
    environment = {**os.environ, "PYTHONHASHSEED": "4711", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", IN_ANOTHER, planner], env=environment, check=True, capture_output=True)
    assert json.loads(done.stdout) == digest(plan)


@both
@pytest.mark.parametrize("limit", [0, 1, 30])
def test_no_more_is_simulated_than_allowed(planner: str, limit: int) -> None:
    plan = planned(planner, simulations=limit)
    assert (plan.status, plan.cost.simulated_actions) == (Status.TIMEOUT, limit)
    assert f"{limit} simulated actions" in plan.reason


@both
def test_what_cannot_be_grasped_is_a_result_that_says_why(planner: str) -> None:
    narrow = scene_of((0.4, 0.1), (0.2, 0.1), shelf=Shelf(0.6, 0.2))
    plan = planned(planner, narrow)
    assert (plan.status, plan.actions) == (Status.FAILED, ())
    assert "half_width" in plan.reason


@pytest.mark.needs_ompl
def test_a_world_that_cannot_be_steered_is_said_to_be_none() -> None:
    pytest.importorskip("ompl")
    with PlanningWorld(WorldSpec(EASY)) as world:
        steered = task_in(world)
        task = Task(
            scene=EASY,
            start=steered.start,
            goal=steered.goal,
            arm=steered.arm,
            topology=create(Kind.TOPOLOGY, "ripser"),
            apply=world.apply,
            rng=steered.rng,
        )
        plan = create(Kind.PLANNER, "grtc-kinodynamic").plan(task)
    assert plan.status is Status.FAILED
    assert "cannot be steered" in plan.reason


class NeverContent(Retrieve):
    """Takes whatever is done for an empty corridor at best."""

    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        return Assessment(Status.CLEARED, "not content")


@pytest.mark.slow
@pytest.mark.needs_ompl
def test_a_reach_that_does_not_succeed_is_tried_again_as_often_as_allowed() -> None:
    pytest.importorskip("ompl")
    with PlanningWorld(WorldSpec(LONE)) as world:
        topology, rng = create(Kind.TOPOLOGY, "ripser"), np.random.default_rng(SEED)
        task = world.task(LONE.initial_state(), topology, rng, goal=NeverContent(RetrieveOptions()))
        plan: Plan = create(Kind.PLANNER, "grtc-kinodynamic", {"attempts": 3}).plan(task)
    assert plan.tree is not None
    grasps = [node for node in plan.tree.nodes if node.action and node.action.kind is ActionKind.GRASP]
    assert (len(grasps), plan.status, plan.reason) == (3, Status.CLEARED, "not content")
    assert len({node.action for node in grasps}) == 3


@pytest.mark.slow
@pytest.mark.needs_ompl
def test_grtc_says_what_its_searches_came_to() -> None:
    plan = planned("grtc-kinodynamic", controls=60, attempts=1)
    assert plan.tree is not None
    pushes = [node for node in plan.tree.nodes[ROOT + 1 :] if node.action and node.action.kind is ActionKind.PUSH]
    assert pushes
    for node in pushes:
        decision = node.decision
        assert isinstance(decision, SteeredDecision)
        assert decision.moved == "o0"
        assert 0 < decision.controls <= 120
        assert decision.drift is not None
        assert 0.0 <= decision.drift < 0.1
        assert node.action is not None
        assert node.action.path.phases[-1] is Phase.RETREAT


@pytest.mark.slow
def test_the_tree_keeps_every_push_that_was_tried_and_why_it_was_left() -> None:
    plan = planned("kinodynamic-rrt", actions=6)
    assert plan.tree is not None
    nodes = plan.tree.nodes[ROOT + 1 :]
    assert len(nodes) == plan.cost.simulated_actions
    tried = [node for node in nodes if node.action and node.action.kind is ActionKind.PUSH]
    parents = Counter(node.parent for node in tried)
    assert all(count % 6 == 0 for count in parents.values())
    assert any("nearer" in node.closed for node in tried)
    assert not any(node.closed for node in plan.tree.path)
    motions = [node.motion for node in plan.tree.path]
    assert all(motion is not None and motion.complete and motion.settled for motion in motions)


def test_impossible_options_are_refused() -> None:
    with pytest.raises(OptionError, match="actions"):
        create(Kind.PLANNER, "kinodynamic-rrt", {"actions": 0})


def test_the_number_of_workers_does_not_change_what_a_budget_leads_to() -> None:
    planner = create(Kind.PLANNER, "kinodynamic-rrt")
    with PlanningWorld(WorldSpec(EASY)) as one, PlanningWorld(WorldSpec(EASY), workers=2) as two:
        for limit in (1, 9, 10, 15, 21):
            alone, together = (planner.plan(task_in(world, simulations=limit)) for world in (one, two))
            assert alone == together
            assert alone.cost.simulated_actions == together.cost.simulated_actions == limit


def test_a_state_that_nothing_blocks_does_not_keep_from_growing_towards_ones_that_something_does() -> None:
    """From the start the grasp fails though nothing blocks it; at the other node an object does."""
    with PlanningWorld(WorldSpec(LONE_AND_ASIDE)) as world:
        task = task_in(world, goal=NeverContent(RetrieveOptions()))
        growing = _Growing(task, KinodynamicRRTOptions(goal_bias=1.0))
        drive = straight_drive(Pushing(task, PushingOptions(half_width=0.12)), task.start)
        assert isinstance(drive, StraightDrive)
        assert growing._opened(ROOT) is None
        assert not growing._drawn(drive).moved
        poses = task.start.poses.copy()
        poses[LONE_AND_ASIDE.index("o0"), :2] = EASY.initial_state().positions[EASY.index("o0")]
        blocked = Transition(replace(task.start, poses=poses), Motion(1.0))
        child = growing._tree.child(ROOT, drive.action, blocked)
        assert growing._opened(child) is None
        assert growing._drawn(drive).moved == "o0"
        assert (growing._tree[ROOT].value, growing._tree[child].value) == (None, -1.0)


class Disturbing(PlanningWorld):
    """Every action of one kind goes wrong in one way, which its motion or state says."""

    def __init__(self, spec: WorldSpec, kind: ActionKind, wrong: str) -> None:
        super().__init__(spec)
        self._kind, self._wrong = kind, wrong

    def apply(self, state: State, action: Action, stop: Stop | None = None, watch: Watch | None = None) -> Transition:
        made = super().apply(state, action, stop, watch)
        if action.kind is not self._kind:
            return made
        if self._wrong == "something toppled":
            conditions = (*made.state.conditions[:-1], Condition.TOPPLED)
            return replace(made, state=replace(made.state, conditions=conditions))
        motion = made.motion
        stalls = self._wrong.startswith("stalled")
        motion = replace(motion, stalled=True, largest_force=0.0) if stalls else replace(motion, settled=False)
        return replace(made, motion=motion)


WRONG = ["something toppled", "stalled at 0 N", "not at rest"]


@pytest.mark.slow
@pytest.mark.parametrize("wrong", WRONG)
def test_nothing_is_grasped_after_drawing_the_arm_out_went_wrong(wrong: str) -> None:
    spent = usual("kinodynamic-rrt").cost.simulated_actions
    with Disturbing(WorldSpec(EASY), ActionKind.MOVE, wrong) as world:
        plan: Plan = create(Kind.PLANNER, "kinodynamic-rrt").plan(task_in(world, simulations=spent + 50))
    assert plan.tree is not None
    moves = [row for row, node in enumerate(plan.tree.nodes) if node.action and node.action.kind is ActionKind.MOVE]
    assert moves
    assert all(plan.tree.nodes[row].closed == wrong for row in moves)
    assert not {node.parent for node in plan.tree.nodes} & set(moves)
    assert not plan.succeeded


@pytest.mark.slow
@pytest.mark.needs_ompl
def test_grtc_does_not_go_on_from_a_push_that_went_wrong() -> None:
    pytest.importorskip("ompl")
    with Disturbing(WorldSpec(EASY), ActionKind.PUSH, WRONG[0]) as world:
        plan: Plan = create(Kind.PLANNER, "grtc-kinodynamic", {"attempts": 1}).plan(task_in(world))
    assert plan.tree is not None
    pushes = [node for node in plan.tree.nodes[ROOT + 1 :] if node.action]
    assert pushes
    assert all(node.closed and node.parent == ROOT for node in pushes)
    assert plan.status is Status.FAILED


@pytest.mark.slow
@pytest.mark.needs_ompl
def test_grtc_solves_an_easy_scene_with_its_other_search_too() -> None:
    plan = planned("grtc-kinodynamic", seed=0, search="kpiece1")
    assert plan.status is Status.RETRIEVED, plan.reason
    assert [action.kind for action in plan.actions] == [ActionKind.PUSH, ActionKind.GRASP]
    assert plan != planned("grtc-kinodynamic", seed=0)
