"""BiEST against its definition: Hsu et al. 1999, with the weights of OMPL's BiEST."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chisquare

from phframe.core import FloatArray
from phframe.motion.expansive_tree import ROOT, ExpansiveTree
from tests.motion.mazes import limits, walls

GAPS = ((0.6, 1.4), (-1.4, -0.6))
RESOLUTION = 0.05
REACH = 0.8


def grown(seed: int, size: int, radius: float = 0.4) -> ExpansiveTree:
    """Some vertices crowded, some alone."""
    rng, tree = np.random.default_rng(seed), ExpansiveTree(3, radius)
    for vertex in range(size):
        tree.add(rng.normal(0.0, 0.2 + (vertex % 2), 3), vertex - 1 if vertex else ROOT)
    return tree


def neighbours(tree: ExpansiveTree) -> FloatArray:
    """Of each vertex, counted pair by pair, itself left out."""
    apart = np.linalg.norm(tree.vertices[:, None] - tree.vertices, axis=2)
    return np.asarray((apart <= tree.radius).sum(axis=1) - 1.0)


@given(seed=st.integers(0, 2**32), size=st.integers(1, 150))
def test_weights_are_one_over_neighbours_and_one(seed: int, size: int) -> None:
    tree = grown(seed, size)
    np.testing.assert_array_equal(tree.weights, 1.0 / (neighbours(tree) + 1.0))


@given(seed=st.integers(0, 2**32), size=st.integers(1, 150))
def test_each_vertex_stands_for_as_much_of_the_chances_as_its_weight(seed: int, size: int) -> None:
    tree = grown(seed, size)
    weights = 1.0 / (neighbours(tree) + 1.0)
    ends = np.cumsum(weights) / weights.sum()
    starts = np.concatenate([[0.0], ends[:-1]])
    for vertex, (start, end) in enumerate(zip(starts, ends, strict=True)):
        assert tree.picked(start + 1e-6 * (end - start)) == vertex
        assert tree.picked(end - 1e-6 * (end - start)) == vertex
    assert tree.picked(0.0) == 0
    assert tree.picked(np.nextafter(1.0, 0.0)) == size - 1


def test_vertices_are_picked_as_often_as_their_weights_say() -> None:
    tree, rng = grown(3, 40), np.random.default_rng(11)
    counts = np.bincount([tree.picked(chance) for chance in rng.random(40_000)], minlength=40)
    weights = 1.0 / (neighbours(tree) + 1.0)
    assert weights.max() / weights.min() > 4.0, "else even picking would pass too"
    assert chisquare(counts, 40_000 * weights / weights.sum()).pvalue > 1e-3
    assert chisquare(counts, np.full(40, 1000.0)).pvalue < 1e-9


@given(seed=st.integers(0, 2**32), size=st.integers(0, 150))
def test_what_is_near_comes_nearest_first_and_a_new_vertex_is_kept_as_rarely_as_it_is_crowded(
    seed: int, size: int
) -> None:
    tree, q = grown(seed, size), np.random.default_rng(seed + 1).normal(0.0, 0.2, 3)
    apart = np.linalg.norm(tree.vertices - q, axis=1)
    found = tree.near(q, 0.7)
    assert set(found.tolist()) == set(np.flatnonzero(apart <= 0.7).tolist())
    assert (np.diff(apart[found]) >= 0.0).all()
    crowd = int((apart <= tree.radius).sum())
    assert tree.acceptance(q) == 1.0 / max(1, crowd)


def planner(seed: int, *, gaps: Any = GAPS, seen: list[FloatArray] | None = None) -> tuple[Any, Any]:
    """BiEST, and the problem: from before the walls to behind them."""
    pytest.importorskip("ompl", reason="needs the extra 'ompl'")
    from phframe.motion import ompl_
    from phframe.motion.biest_ import BiEST
    from phframe.motion.edges import Edges

    valid = walls(*gaps)

    def noted(q: FloatArray) -> bool:
        if seen is not None:
            seen.append(q)
        return valid(q)

    space = ompl_._space(limits(3, len(gaps)))
    ends = np.array([[0.4, 0.0, 0.0], [len(gaps) + 0.6, 0.0, 0.0]])
    problem = ompl_._problem(space, Edges(noted, RESOLUTION), ends[0], ends[1:])
    chosen = BiEST(problem.getSpaceInformation(), REACH, np.random.default_rng(seed))
    chosen.setProblemDefinition(problem)
    chosen.setup()
    return chosen, problem


def rounds(count: int) -> Any:
    from ompl import base

    left = iter(range(count))
    return base.PlannerTerminationCondition(lambda: next(left, None) is None)


@pytest.mark.needs_ompl
@pytest.mark.parametrize("seed", range(5))
def test_trees_are_valid_and_as_their_vertices_say(seed: int) -> None:
    chosen, problem = planner(seed, gaps=((5.0, 6.0),))
    assert chosen.solve(rounds(1500)).getStatus().name == "TIMEOUT"
    assert not problem.hasExactSolution()
    valid = walls((5.0, 6.0))
    for tree, root in zip(chosen.trees, ([0.4, 0.0, 0.0], [1.6, 0.0, 0.0]), strict=True):
        assert tree.size > 20
        assert tree.parents[0] == ROOT
        np.testing.assert_array_equal(tree.vertices[0], root)
        np.testing.assert_array_equal(tree.weights, 1.0 / (neighbours(tree) + 1.0))
        lower, upper = limits(3, 1)
        assert ((lower <= tree.vertices) & (tree.vertices <= upper)).all()
        for vertex in range(1, tree.size):
            parent = int(tree.parents[vertex])
            assert 0 <= parent < vertex, "a tree, each vertex added to one that was there"
            a, b = tree.vertices[parent], tree.vertices[vertex]
            assert np.abs(b - a).max() <= REACH
            steps = int(np.ceil(np.abs(b - a).max() / RESOLUTION - 1e-9))
            assert all(valid(q) for q in a + np.linspace(0.0, 1.0, steps + 1)[:, None] * (b - a))


@pytest.mark.needs_ompl
def test_trees_take_turns_and_spread_over_all_that_they_can_reach() -> None:
    chosen, _ = planner(1, gaps=((5.0, 6.0),))
    chosen.solve(rounds(4000))
    starts, goals = chosen.trees
    assert 0.5 < starts.size / goals.size < 2.0
    for tree in (starts, goals):
        cells = np.floor((tree.vertices[:, 1:] + 2.0) / 0.5).clip(0, 7).astype(int)
        filled = np.zeros((8, 8), dtype=bool)
        filled[tuple(cells.T)] = True
        assert filled.mean() > 0.9


@pytest.mark.needs_ompl
def test_configurations_are_drawn_evenly_from_the_box_within_reach() -> None:
    chosen, _ = planner(4, gaps=())
    lower, upper = limits(3, 0)
    q = np.array([0.4, 1.5, 0.0])
    drawn = np.array([chosen._drawn_near(q) for _ in range(4000)])
    for joint in range(3):
        box = max(lower[joint], q[joint] - REACH), min(upper[joint], q[joint] + REACH)
        assert box[0] <= drawn[:, joint].min() < drawn[:, joint].max() <= box[1]
        assert chisquare(np.histogram(drawn[:, joint], 10, box)[0]).pvalue > 1e-3


@pytest.mark.needs_ompl
def test_a_tree_grows_from_each_vertex_as_often_as_the_definition_says() -> None:
    """One round from the same crowded tree, many times: who was the parent, if a vertex was kept at all."""
    chosen, _ = planner(5, gaps=())
    crowd = np.random.default_rng(1).normal((0.5, 0.0, 0.0), 0.25, (49, 3))
    planted = ExpansiveTree(3, chosen.trees[0].radius)
    for q in (*crowd, np.array([0.5, 1.8, 1.8])):
        planted.add(q)
    trials, expected = 3000, grown_from(planted, 20_000)
    counts = np.zeros(51)
    for _ in range(trials):
        chosen._trees, chosen._turn = (copy.deepcopy(planted), ExpansiveTree(3, 1.0)), 0
        assert chosen._grown() is None
        tree = chosen.trees[0]
        counts[tree.parents[50] if tree.size == 51 else 50] += 1
    assert 0.1 < expected[50] < 0.9, "some are kept, some are not"
    assert chisquare(counts, trials * expected).pvalue > 1e-3


def grown_from(tree: ExpansiveTree, draws: int) -> FloatArray:
    """How probably each vertex ``(size,)`` is the parent of a new one, and that there is none, by the definition."""
    weights, (lower, upper) = 1.0 / (neighbours(tree) + 1.0), limits(3, 0)
    rng, kept = np.random.default_rng(2), []
    for vertex in tree.vertices:
        drawn = rng.uniform(np.maximum(lower, vertex - REACH), np.minimum(upper, vertex + REACH), (draws, 3))
        crowd = (np.linalg.norm(drawn[:, None] - tree.vertices, axis=2) <= tree.radius).sum(axis=1)
        kept.append(float((1.0 / np.maximum(1, crowd)).mean()))
    fractions = weights / weights.sum() * kept
    return np.append(fractions, 1.0 - fractions.sum())


@pytest.mark.needs_ompl
@pytest.mark.parametrize("seed", range(10))
def test_paths_follow_the_trees_from_start_to_goal(seed: int) -> None:
    chosen, problem = planner(seed)
    assert chosen.solve(rounds(20_000)).getStatus().name == "EXACT_SOLUTION"
    states = problem.getSolutionPath().getStates()
    path = np.array([[state[i] for i in range(3)] for state in states])
    np.testing.assert_array_equal(path[[0, -1]], [[0.4, 0.0, 0.0], [2.6, 0.0, 0.0]])
    assert problem.getSolutionPath().check()
    vertices = {vertex.tobytes() for tree in chosen.trees for vertex in tree.vertices}
    assert all(q.tobytes() in vertices for q in path)


@pytest.mark.needs_ompl
def test_seeds_repeat_and_differ() -> None:
    def vertices(seed: int) -> bytes:
        chosen, _ = planner(seed)
        chosen.solve(rounds(20_000))
        return b"".join(tree.vertices.tobytes() for tree in chosen.trees)

    assert vertices(1) == vertices(1) != vertices(2)


@pytest.mark.needs_ompl
def test_it_goes_on_where_it_was_and_starts_anew_when_cleared() -> None:
    whole, _ = planner(6, gaps=((5.0, 6.0),))
    whole.solve(rounds(300))
    halves, _ = planner(6, gaps=((5.0, 6.0),))
    halves.solve(rounds(120))
    halves.solve(rounds(180))
    for one, other in zip(whole.trees, halves.trees, strict=True):
        assert one.vertices.tobytes() == other.vertices.tobytes()
    halves.clear()
    assert [tree.size for tree in halves.trees] == [0, 0]
    halves.solve(rounds(1))
    assert halves.trees[0].size >= 1


@pytest.mark.needs_ompl
def test_ompls_own_setup_runs_it() -> None:
    """From C++, where its type is that of any planner."""
    pytest.importorskip("ompl")
    from ompl import geometric, util

    from phframe.motion.biest_ import BiEST

    _, problem = planner(0)
    si = problem.getSpaceInformation()
    setup, ends = geometric.SimpleSetup(si), (si.allocState(), si.allocState())
    for state, first in zip(ends, (0.4, 2.6), strict=True):
        state[0], state[1], state[2] = first, 0.0, 0.0
    setup.setStartAndGoalStates(*ends)
    setup.setPlanner(BiEST(si, REACH, np.random.default_rng(0)))
    level = util.getLogLevel()
    try:
        util.setLogLevel(util.LOG_NONE)
        assert setup.solve(20.0).getStatus().name == "EXACT_SOLUTION"
    finally:
        util.setLogLevel(level)
