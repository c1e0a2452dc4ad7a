"""What holds for every engine, and between them. What is expected comes from plain definitions, not from an engine."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from phframe.core import FloatArray, Options, PersistenceDiagram, TopologyEngine, rotation_matrix
from phframe.core.topology import FLOAT32_SLACK
from phframe.topology.ripser_ import Ripser
from phframe.topology.single_linkage import SingleLinkage

ENGINES: list[TopologyEngine[Options]] = [Ripser(Options()), SingleLinkage(Options())]
every_engine = pytest.mark.parametrize("engine", ENGINES, ids=lambda engine: type(engine).__name__)

properties = settings(deadline=None, max_examples=60)
"""A busy machine is not a failure."""

NOTHING = np.empty((0, 2))
BASIC = np.array([[0.1, 0.1], [0.1, 0.1], [0.2, 0.1], [0.2, 0.4]])

grid = st.integers(0, 12).map(lambda step: step * 0.05)
"""Ties, points that coincide, and points in a row."""
anywhere = st.floats(-2.0, 2.0, allow_subnormal=False)


def point_sets(min_size: int = 0) -> st.SearchStrategy[FloatArray]:
    def of(coordinate: st.SearchStrategy[float]) -> st.SearchStrategy[FloatArray]:
        pairs = st.lists(st.tuples(coordinate, coordinate), min_size=min_size, max_size=25)
        return pairs.map(lambda points: np.array(points, dtype=np.float64).reshape(-1, 2))

    return st.one_of(of(grid), of(anywhere))


def edges(points: FloatArray) -> list[tuple[float, int, int]]:
    """All pairs, nearest first."""
    pairs = combinations(range(len(points)), 2)
    return sorted((float(np.hypot(*(points[i] - points[j]))), i, j) for i, j in pairs)


def spanning_tree_lengths(points: FloatArray) -> list[float]:
    """Edge lengths of a minimum spanning tree, by Kruskal's algorithm."""
    tree_of = list(range(len(points)))
    lengths = []
    for length, i, j in edges(points):
        if tree_of[i] != tree_of[j]:
            lengths.append(length)
            tree_of = [tree_of[i] if tree == tree_of[j] else tree for tree in tree_of]
    return lengths


def components_of_graph(points: FloatArray, radius: float) -> set[frozenset[int]]:
    """Connected components of the graph that joins points at most ``radius`` apart, by merging sets."""
    components = [{i} for i in range(len(points))]
    for length, i, j in edges(points):
        if length <= radius:
            joined = [c for c in components if i in c or j in c]
            components = [c for c in components if c not in joined] + [set().union(*joined)]
    return {frozenset(c) for c in components}


def as_sets(labels: np.ndarray) -> set[frozenset[int]]:
    return {frozenset(np.flatnonzero(labels == label).tolist()) for label in set(labels.tolist())}


@properties
@given(point_sets())
@example(NOTHING)
@example(np.zeros((1, 2)))
@example(np.zeros((3, 2)))
@example(np.array([[0.0, 0.0], [1e-50, 0.0]]))
def test_the_engines_give_equal_diagrams_bit_by_bit(points: FloatArray) -> None:
    first, second = (engine.diagram(points) for engine in ENGINES)
    assert first == second


@properties
@given(point_sets(), st.floats(0.0, 1.0))
def test_the_engines_give_equal_components(points: FloatArray, radius: float) -> None:
    first, second = (engine.components(points, radius) for engine in ENGINES)
    np.testing.assert_array_equal(first, second)


@every_engine
@properties
@given(points=point_sets())
def test_deaths_are_the_edge_lengths_of_the_minimum_spanning_tree(
    engine: TopologyEngine[Options], points: FloatArray
) -> None:
    lengths = np.array(spanning_tree_lengths(points), dtype=np.float32)
    np.testing.assert_allclose(engine.diagram(points).finite_deaths, lengths[lengths > 0.0], rtol=2e-7)


@every_engine
@properties
@given(points=point_sets())
def test_a_diagram_is_well_formed(engine: TopologyEngine[Options], points: FloatArray) -> None:
    before = points.copy()
    diagram = engine.diagram(points)
    assert (diagram.births == 0.0).all()
    assert diagram.births.shape == diagram.deaths.shape
    assert (diagram.deaths > 0.0).all()
    assert (np.diff(diagram.finite_deaths) >= 0.0).all()
    assert np.isinf(diagram.deaths).tolist() == [False] * len(diagram.finite_deaths) + [True] * bool(len(points))
    np.testing.assert_array_equal(points, before)
    assert engine.diagram(points) == diagram


@every_engine
@properties
@given(points=point_sets(), data=st.data())
def test_the_order_of_the_points_does_not_matter(
    engine: TopologyEngine[Options], points: FloatArray, data: st.DataObject
) -> None:
    order = data.draw(st.permutations(range(len(points))))
    shuffled = points[np.array(order, dtype=np.int64)]
    assert engine.diagram(shuffled) == engine.diagram(points)
    moved = {frozenset(order[i] for i in members) for members in as_sets(engine.components(shuffled, 0.3))}
    assert moved == as_sets(engine.components(points, 0.3))


@every_engine
@properties
@given(points=point_sets(), angle=st.floats(-np.pi, np.pi), shift=st.tuples(anywhere, anywhere), mirrored=st.booleans())
def test_turning_shifting_and_mirroring_change_nothing(
    engine: TopologyEngine[Options], points: FloatArray, angle: float, shift: tuple[float, float], mirrored: bool
) -> None:
    moved = points @ rotation_matrix(angle).T * [-1.0 if mirrored else 1.0, 1.0] + shift
    lengths = [np.zeros(len(points)), np.zeros(len(points))]  # points that coincide may come apart by rounding
    for padded, diagram in zip(lengths, (engine.diagram(points), engine.diagram(moved)), strict=True):
        padded[len(points) - len(diagram.finite_deaths) :] = diagram.finite_deaths
    np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-6, atol=1e-6)


@every_engine
@properties
@given(points=point_sets(), radius=st.floats(0.0, 1.0))
@example(points=BASIC, radius=0.0)
@example(points=BASIC, radius=0.1)
def test_components_are_those_of_the_graph_at_the_radius(
    engine: TopologyEngine[Options], points: FloatArray, radius: float
) -> None:
    limit = radius + FLOAT32_SLACK
    assume(all(abs(length - limit) > 1e-9 for length, _, _ in edges(points)))
    labels = engine.components(points, radius)
    assert as_sets(labels) == components_of_graph(points, limit)
    first_seen = list(dict.fromkeys(labels.tolist()))
    assert first_seen == list(range(len(first_seen)))


@every_engine
@properties
@given(points=point_sets(min_size=1))
def test_at_a_death_the_components_have_merged(engine: TopologyEngine[Options], points: FloatArray) -> None:
    deaths = engine.diagram(points).finite_deaths
    for death in deaths:
        found = len(as_sets(engine.components(points, float(death))))
        assert 1 + (deaths > death + 2 * FLOAT32_SLACK).sum() <= found <= 1 + (deaths > death).sum()


@every_engine
@pytest.mark.parametrize(
    ("points", "deaths"),
    [
        (NOTHING, []),
        ([[0.3, 0.1]], [np.inf]),
        ([[0.3, 0.1]] * 4, [np.inf]),
        ([[0.0, 0.0], [0.0, 0.25]], [0.25, np.inf]),
        ([[0.0, 0.0], [0.5, 0.0], [0.0, 0.25], [0.0, 0.0]], [0.25, 0.5, np.inf]),
        ([[0.0, 0.0], [0.3, 0.0], [0.0, 0.4]], [np.float32(0.3), np.float32(0.4), np.inf]),
    ],
    ids=["none", "one", "coinciding", "two", "two coinciding of four", "rounded to float32"],
)
def test_diagrams_worked_out_by_hand(
    engine: TopologyEngine[Options], points: list[list[float]], deaths: list[float]
) -> None:
    expected = PersistenceDiagram(np.zeros(len(deaths)), np.array(deaths))
    assert engine.diagram(np.array(points)) == expected


@every_engine
def test_components_of_no_points_are_none(engine: TopologyEngine[Options]) -> None:
    assert engine.components(NOTHING, 0.1).shape == (0,)


@every_engine
def test_components_worked_out_by_hand(engine: TopologyEngine[Options]) -> None:
    assert engine.components(BASIC, 0.05).tolist() == [0, 0, 1, 2]
    assert engine.components(BASIC, 0.1).tolist() == [0, 0, 0, 1]
    assert engine.components(BASIC[::-1], 0.1).tolist() == [0, 1, 1, 1]
    assert engine.components(BASIC, 0.3).tolist() == [0, 0, 0, 0]
