"""OMPL's searches among controls: they get there, by controls that lead there, and the same every time."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Literal

import numpy as np
import pytest

from phframe.core import BudgetExceededError
from phframe.kinodynamic.region import GripperNear, ObjectNear, pose_coordinates
from phframe.kinodynamic.steered_tree import Controls, SteeredTree
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.kinodynamic.test_steered_tree import ROOM, SCENE, task_of, tree_in

pytest.importorskip("ompl")
pytestmark = pytest.mark.needs_ompl

from phframe.kinodynamic.ompl_ import search_controls  # noqa: E402 # only where OMPL is

GRIPPER = GripperNear.of(np.array([0.05, 0.42, 0.1]), 0.05, ROOM)
BEYOND = GripperNear.of(np.array([0.55, 0.55, -0.6]), 1e-3, ROOM)
"""Too small to be met."""
PLACE = ObjectNear(
    SCENE.index("o0"),
    np.array([0.2, 0.3]),
    np.array([-0.05, 0.0]),
    0.0,
    0.05,
    np.concatenate([pose_coordinates(ROOM.lower), np.zeros(2)]),
    np.concatenate([pose_coordinates(ROOM.upper), np.full(2, 0.6)]),
)
Search = Literal["rrt", "kpiece1"]
BOTH: tuple[Search, ...] = ("rrt", "kpiece1")
searches = pytest.mark.parametrize("search", BOTH)


def searched(
    search: Search,
    region: GripperNear | ObjectNear = GRIPPER,
    seed: int = 1,
    most: int = 600,
    simulations: int | None = None,
) -> tuple[int | None, SteeredTree]:
    with PlanningWorld(WorldSpec(SCENE)) as world:
        tree = tree_in(task_of(world, simulations=simulations))
        end = search_controls(
            tree, region, Controls(), search=search, goal_bias=0.6, most=most, rng=np.random.default_rng(seed)
        )  # fmt: skip
        return end, tree


@searches
def test_it_gets_there_by_controls_that_lead_there(search: Search) -> None:
    end, tree = searched(search)
    assert end is not None
    assert GRIPPER.reached(tree[end].state)
    twists = tree.twists(end)
    assert (np.abs(twists) <= 0.1).all()
    np.testing.assert_allclose(tree[0].pose + twists.sum(axis=0), tree[end].pose, atol=5e-3)
    assert not any(tree[row].fault for row in tree.branch(end))


@pytest.mark.slow
def test_an_object_is_pushed_to_its_place() -> None:
    end, tree = searched("rrt", PLACE)
    assert end is not None
    at = tree[end].state.positions[SCENE.index("o0")]
    assert np.linalg.norm(at - PLACE.place) <= 0.05


@searches
def test_no_more_controls_than_allowed_are_tried(search: Search) -> None:
    end, tree = searched(search, BEYOND, most=40)
    assert end is None
    assert tree.tried == 40


@searches
def test_a_spent_budget_comes_out_as_it_is(search: Search) -> None:
    with pytest.raises(BudgetExceededError):
        searched(search, BEYOND, simulations=5)


def test_where_it_is_already_nothing_is_tried() -> None:
    near = GripperNear.of(np.array([-0.1, 0.3, 0.0]), 0.05, ROOM)
    end, tree = searched("rrt", near)
    assert (end, tree.tried) == (0, 0)


@searches
def test_the_same_seed_gives_the_same_controls_whatever_ran_before(search: Search) -> None:
    end, tree = searched(search)
    searched("rrt", seed=7, most=30)
    again, other = searched(search)
    assert end is not None
    assert again == end
    assert other.twists(end).tobytes() == tree.twists(end).tobytes()
    assert searched(search, seed=2)[1].twists(1).tobytes() != tree.twists(1).tobytes()


IN_ANOTHER = """
import json
from tests.kinodynamic.test_control_search import searched
print(json.dumps([[end, tree.twists(end).tolist()] for end, tree in map(searched, ("rrt", "kpiece1"))]))
"""


@pytest.mark.slow
def test_two_processes_find_the_same_controls() -> None:
    environment = {**os.environ, "PYTHONHASHSEED": "4711", "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", IN_ANOTHER]
    theirs = json.loads(subprocess.run(command, env=environment, check=True, capture_output=True).stdout)
    ours = [(end, tree.twists(end or 0).tolist()) for end, tree in map(searched, BOTH)]
    assert theirs == [list(each) for each in ours]


def test_nothing_is_said_on_the_console(capfd: pytest.CaptureFixture[str]) -> None:
    searched("kpiece1", most=30)
    assert capfd.readouterr() == ("", "")
