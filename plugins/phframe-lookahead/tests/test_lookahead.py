"""The planner in real worlds: pymunk with the planar arm."""

from __future__ import annotations

from importlib import metadata
from typing import Any

import pytest

from phframe import solve
from phframe.core import ROOT, Action, ExploredTree, Plan, Scene, State, Status
from phframe.pushing import Corridor, PushDecision, find_corridor
from phframe.registry import Kind, create, discover, load
from phframe.testing import PLANNER_CHECKS, Check, PlannerUnderTest, simulated_tasks
from phframe_lookahead import phframe_extensions
from phframe_lookahead.lookahead import Lookahead

make_task = simulated_tasks()
UNSAFE = ("nothing moved", "stalled", "contact", "something")
"""What begins the reasons why a sweep is not taken whatever it leaves."""


def scene_named(name: str) -> Scene:
    scene: Scene = create(Kind.SCENES, "vieira").load(name)
    return scene


def plan_for(name: str, rejected: tuple[Action, ...] = (), **options: Any) -> Plan:
    task = make_task(scene_named(name), rejected=rejected)
    return Lookahead(Lookahead.options_type(**options)).plan(task)


def tree_of(plan: Plan) -> ExploredTree:
    assert plan.tree is not None
    return plan.tree


@pytest.mark.parametrize("check", PLANNER_CHECKS, ids=lambda check: check.name)
def test_it_keeps_to_the_interface(check: Check[PlannerUnderTest]) -> None:
    check(PlannerUnderTest(Lookahead(Lookahead.options_type()), make_task))


@pytest.mark.parametrize("name", ["basic", "simple-03", "example-05"])
def test_it_brings_the_target_out(name: str) -> None:
    plan = plan_for(name)
    assert plan.status is Status.RETRIEVED, plan.reason
    assert plan.expected[-1].held == scene_named(name).target


def in_the_way(scene: Scene, state: State) -> int:
    """Obstacles in the corridor to the target, wherever that is now."""
    row = scene.target_index
    corridor = find_corridor(state.positions[row], scene.shelf, 0.12)
    assert isinstance(corridor, Corridor)
    inside = corridor.contains(state.positions) & state.on_board
    inside[row] = False
    return int(inside.sum())


@pytest.mark.parametrize("name", ["basic", "example-03", "example-05"])
def test_each_push_leaves_the_fewest_in_the_way_and_of_several_takes_the_least_time(name: str) -> None:
    scene, choices = scene_named(name), 0
    plan = plan_for(name)
    tree = tree_of(plan)
    assert plan.status is Status.RETRIEVED
    for node in tree.path[:-1]:
        tried = [other for other in tree.nodes if other.parent == node.parent and not other.closed.startswith(UNSAFE)]
        ranks = [(in_the_way(scene, each.state), each.motion.duration) for each in tried if each.motion is not None]
        assert node.motion is not None
        assert (in_the_way(scene, node.state), node.motion.duration) == min(ranks)
        choices += len(ranks) > 1
    assert choices


def test_it_looks_at_groups_and_at_every_single_obstacle() -> None:
    tree = tree_of(plan_for("basic"))
    first = [node for node in tree.nodes if node.parent == ROOT]
    moved = {node.action.moves for node in first if node.action is not None}
    members = PushDecision.of(first[0].decision).members
    assert {(member,) for member in members} <= moved
    assert any(len(group) > 1 for group in moved)
    paths = [node.action.path.poses.tobytes() for node in first if node.action is not None]
    assert len(set(paths)) == len(paths), "no sweep is simulated twice"


def test_it_gives_up_after_its_number_of_pushes() -> None:
    needed = len(plan_for("example-03").actions) - 1
    plan = plan_for("example-03", max_actions=needed - 1)
    assert (plan.status, plan.reason) == (Status.FAILED, f"the corridor is not empty after {needed - 1} actions")


def test_what_was_rejected_is_not_proposed_again() -> None:
    usual = plan_for("basic")
    other = plan_for("basic", rejected=usual.actions)
    assert not [action for action in other.actions if any(map(action.resembles, usual.actions))]


@pytest.fixture
def installed() -> None:
    if not [point for point in metadata.distributions() if point.name == "lookahead"]:
        pytest.skip("phframe-lookahead is importable here, but not installed")


@pytest.mark.usefixtures("installed")
def test_an_episode_is_run_with_it_by_name() -> None:
    episode = solve("vieira/simple-03", planner="lookahead")
    assert episode.spec.planner == "lookahead"
    assert episode.status is Status.RETRIEVED, episode.reason


@pytest.mark.usefixtures("installed")
def test_it_is_found_by_its_entry_point() -> None:
    found = discover(metadata.distributions(), only=["phframe-lookahead"])
    entry = found.find(Kind.PLANNER, "lookahead")
    assert (entry.distribution, entry.extension) == ("phframe-lookahead", phframe_extensions()[0])
    assert load(Kind.PLANNER, "lookahead", found) is Lookahead
