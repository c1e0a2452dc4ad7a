"""PHIM: which push is tried next, what it is worth, and what becomes of a path."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from itertools import pairwise

import numpy as np
import pytest

from phframe.core import ROOT, ActionKind, ExploredTree, FloatArray, SearchNode, State, Status
from phframe.planners.phim import PHIM, PHIMOptions, upper_confidence_bound
from phframe.pushing import Corridor, find_corridor
from phframe.runtime.scenes import find_scene
from phframe.testing import simulated_tasks
from tests.planners.solved import PUBLISHED, episodes

H = 1.1 * 0.018 + 2 * 0.03


def tree_for(name: str, **options: float) -> ExploredTree:
    plan = PHIM(PHIMOptions.parse(options, "phim")).plan(simulated_tasks()(find_scene(name)))
    assert plan.tree is not None
    return plan.tree


def is_push(node: SearchNode) -> bool:
    return node.action is not None and node.action.kind is ActionKind.PUSH


def pushes_below(tree: ExploredTree, row: int) -> list[int]:
    """The nodes that pushes led to, from one of them down, itself included."""
    rows = [row] if is_push(tree.nodes[row]) else []
    below = [child for child, node in enumerate(tree.nodes) if node.parent == row]
    return rows + [each for child in below for each in pushes_below(tree, child)]


def components(points: FloatArray) -> int:
    """Connected by distances up to h: single linkage, by the rank of the graph's Laplacian."""
    near = np.linalg.norm(points[:, None] - points[None], axis=2) <= H + 1e-4
    laplacian = np.diag(near.sum(axis=1)) - near.astype(float)
    return len(points) - int(np.linalg.matrix_rank(laplacian)) if len(points) else 0


def in_the_way(name: str, state: State) -> FloatArray:
    scene = find_scene(name)
    row = scene.target_index
    corridor = find_corridor(state.positions[row], scene.shelf, 0.12)
    assert isinstance(corridor, Corridor)
    inside = corridor.contains(state.positions) & state.on_board
    inside[row] = False
    return state.positions[inside]


def reward(name: str, tree: ExploredTree, row: int) -> float:
    """Of the push that led to a node, from the two states alone."""
    node = tree.nodes[row]
    if node.closed.startswith(("stalled", "nothing moved", "something", "contact")):
        return 0.0
    assert node.parent is not None
    before, after = in_the_way(name, tree.nodes[node.parent].state), in_the_way(name, node.state)
    removed = len(before) - len(after)
    return removed + (components(after) - components(before) if removed >= 0 else 0)


def test_the_upper_confidence_bound_of_a_small_example() -> None:
    assert upper_confidence_bound(2.0, 3, 10, 1.5) == pytest.approx(2.0 + 1.5 * math.sqrt(math.log(10) / 3))
    assert upper_confidence_bound(2.0, 3, 10, 0.0) == 2.0
    assert upper_confidence_bound(0.0, 1, 1, 7.0) == 0.0
    assert upper_confidence_bound(1.0, 1, 10, 1.0) > upper_confidence_bound(1.3, 5, 10, 1.0), "seldom visited"


@pytest.mark.parametrize("name", ["vieira/basic", "vieira/example-04", "vieira/example-09"])
def test_the_value_of_a_node_is_the_mean_reward_of_the_pushes_that_led_there_or_further(name: str) -> None:
    tree, rewards = tree_for(name), set()
    for row, node in enumerate(tree.nodes):
        if is_push(node) or row == ROOT:
            below = [reward(name, tree, each) for each in pushes_below(tree, row)]
            assert node.value == pytest.approx(np.mean(below))
            rewards |= set(below)
    assert len(rewards) >= 2


@pytest.mark.parametrize("exploration", [0.0, 1.0, 100.0])
def test_each_push_is_tried_where_the_greatest_bounds_lead(exploration: float) -> None:
    """Replays the search: where it went follows from the rewards so far alone."""
    name = "vieira/basic"
    tree = tree_for(name, exploration=exploration, iterations=40)
    rows = [row for row, node in enumerate(tree.nodes) if is_push(node)]
    offered = Counter(tree.nodes[row].parent for row in rows)
    visits, made = Counter[int | None](), Counter[int | None]()
    total: dict[int, float] = defaultdict(float)

    def is_finished(node: int, known: list[int]) -> bool:
        children = [row for row in known if tree.nodes[row].parent == node]
        return made[node] >= offered[node] and all(is_finished(child, known) for child in children)

    for number, row in enumerate(rows[:25]):
        known, node = rows[:number], ROOT
        while made[node] >= offered[node]:
            children = [each for each in known if tree.nodes[each].parent == node and not is_finished(each, known)]
            node = max(
                children,
                key=lambda child: upper_confidence_bound(
                    total[child] / visits[child],
                    visits[child],
                    visits[node],
                    exploration,
                ),
            )
        assert tree.nodes[row].parent == node
        made[node] += 1
        gained = reward(name, tree, row)
        above: int | None = row
        while above is not None:
            visits[above] += 1
            total[above] += gained
            above = tree.nodes[above].parent
    assert len(rows) >= 10


@pytest.mark.slow
def test_all_published_scenes_are_retrieved_in_fewer_pushes_than_by_phia() -> None:
    found = episodes("phim")
    assert [each.scene.name for each in found if each.status is not Status.RETRIEVED or not each.clean] == []
    assert len(found) == len(PUBLISHED)
    assert sum(each.pushes for each in found) < 0.8 * sum(each.pushes for each in episodes("phia"))


@pytest.mark.parametrize("name", ["vieira/basic", "vieira/example-04"])
def test_the_shortest_path_that_ends_with_the_target_in_the_hand_is_chosen(name: str) -> None:
    tree = tree_for(name)
    ends = [row for row, node in enumerate(tree.nodes) if node.state.held]
    lengths = [len(ExploredTree(tree.nodes, row).path) for row in ends]
    assert len(tree.path) == min(lengths)
    assert tree.nodes[tree.chosen].state.held
    for row, node in enumerate(tree.nodes):
        assert bool(node.closed) is not (row == ROOT or node in tree.path)


def test_no_more_pushes_are_simulated_than_iterations_for_each_action() -> None:
    for iterations in (1, 5, 15):
        plan = PHIM(PHIMOptions(iterations=iterations)).plan(simulated_tasks()(find_scene("vieira/basic")))
        assert plan.tree is not None
        pushes = sum(map(is_push, plan.tree.nodes))
        assert pushes <= iterations * PHIMOptions().max_actions
        assert plan.status is Status.RETRIEVED
        if len(plan.actions) == 2:
            assert pushes <= iterations


def test_it_goes_back_where_nothing_is_left_to_try() -> None:
    plan = PHIM(PHIMOptions(iterations=3)).plan(simulated_tasks()(find_scene("random/9")))
    assert plan.tree is not None
    parents = [node.parent or ROOT for node in plan.tree.nodes if is_push(node)]
    assert any(later < earlier for earlier, later in pairwise(parents))
