"""What is checked of a topology engine."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from phframe.core import FloatArray, IntArray, PersistenceDiagram, rotation_matrix
from phframe.core.topology import FLOAT32_SLACK
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_close, expect_equal
from phframe.testing.subjects import EngineUnderTest
from phframe.testing.tolerances import DIAGRAM
from phframe.testing.topology.points import clear_radii, flood_labels, partition, point_sets, tree_edges


@check
def diagrams_are_well_formed(subject: EngineUnderTest) -> Faults:
    """PersistenceDiagram: births 0, deaths above 0 and ascending, the last one infinite and no other."""
    for name, points in point_sets():
        diagram = subject.engine.diagram(points)
        births, deaths = diagram.births, diagram.deaths
        yield from expect(births.shape == deaths.shape and not births.any(), f"births of 0 for {name}", str(births))
        yield from expect((deaths > 0.0).all(), f"no bar of no length for {name}", str(deaths))
        yield from expect((deaths[1:] >= deaths[:-1]).all(), f"ascending deaths for {name}", str(deaths))
        infinite = np.isinf(deaths).tolist()
        wanted = [False] * (len(deaths) - 1) + [True]
        yield from expect(infinite == wanted, f"one infinite death, the last, for {name}", str(deaths))


@check
def no_points_and_one_point_have_diagrams(subject: EngineUnderTest) -> Faults:
    """TopologyEngine.diagram: empty for no points, one infinite bar for a single one."""
    for points, deaths in (
        (np.empty((0, 2)), []),
        (np.array([[0.2, 0.3]]), [np.inf]),
        (np.full((4, 2), 0.1), [np.inf]),
    ):
        expected = PersistenceDiagram(np.zeros(len(deaths)), np.array(deaths))
        yield from expect_equal(subject.engine.diagram(points), expected, f"the diagram of {len(points)} points")


@check
def no_points_have_no_components(subject: EngineUnderTest) -> Faults:
    """TopologyEngine.components: labels (n,)."""
    yield from expect_equal(subject.engine.components(np.empty((0, 2)), 0.1).shape, (0,), "the shape of no labels")


@check
def deaths_are_edges_of_the_minimum_spanning_tree(subject: EngineUnderTest) -> Faults:
    """PersistenceDiagram: a death is the distance at which components merge; bars of no length are left out.

    In dimension 0 of the Vietoris-Rips filtration, deaths are the edge lengths of the minimum spanning tree.
    """
    for name, points in point_sets():
        edges = tree_edges(points)
        yield from _same_deaths(subject.engine.diagram(points), edges[edges > 0.0], f"the deaths for {name}")


@check
def order_of_points_does_not_matter(subject: EngineUnderTest) -> Faults:
    """TopologyEngine: the diagram and the components belong to the set of points, not to its order."""
    for name, points in point_sets():
        order = np.random.default_rng(5).permutation(len(points))
        diagram = subject.engine.diagram(points)
        yield from _same_deaths(subject.engine.diagram(points[order]), diagram.finite_deaths, f"{name}, reordered")
        for radius in clear_radii(points):
            labels = subject.engine.components(points, radius)[order]
            found = partition(subject.engine.components(points[order], radius))
            yield from expect_equal(found, partition(labels), f"the components of {name}, reordered, at {radius:g} m")


@check
def moving_all_points_does_not_matter(subject: EngineUnderTest) -> Faults:
    """PersistenceDiagram: deaths are distances, which turning, shifting and mirroring keep."""
    for name, points in point_sets():
        for moved, how in _moved(points):
            deaths = subject.engine.diagram(points).finite_deaths
            yield from _same_deaths(subject.engine.diagram(moved), deaths, f"the deaths of {name}, {how}")
            for radius in clear_radii(points):
                labels = subject.engine.components(moved, radius)
                wanted = subject.engine.components(points, radius)
                yield from _same_labels(labels, wanted, f"the components of {name}, {how}, at {radius:g} m")


@check
def scaling_the_points_scales_the_deaths(subject: EngineUnderTest) -> Faults:
    """PersistenceDiagram: deaths are in metres, like the points."""
    for name, points in point_sets():
        for factor in (0.25, 4.0):  # powers of two: float32 rounds both alike
            wanted = subject.engine.diagram(points).finite_deaths * factor
            yield from _same_deaths(
                subject.engine.diagram(points * factor), wanted, f"{name}, {factor:g} times as large"
            )


@check
def components_are_those_of_single_linkage(subject: EngineUnderTest) -> Faults:
    """TopologyEngine.components: single linkage at distance <= radius, labels from 0 in order of first appearance."""
    for name, points in point_sets():
        for radius in clear_radii(points):
            labels = subject.engine.components(points, radius)
            yield from _same_labels(labels, flood_labels(points, radius), f"the components of {name} at {radius:g} m")


@check
def components_agree_with_the_diagram(subject: EngineUnderTest) -> Faults:
    """TopologyEngine: at every radius there are as many components as bars that are still alive.

    At a death, which may have been rounded to float32, the two components have merged.
    """
    for name, points in point_sets():
        deaths = subject.engine.diagram(points).deaths
        for radius in clear_radii(points):
            count = len(set(subject.engine.components(points, radius).tolist()))
            yield from expect_equal(count, int((deaths > radius).sum()), f"components of {name} at {radius:g} m")
        for death in deaths[:-1]:
            alive = int((deaths > death + 2.0 * FLOAT32_SLACK).sum()), int((deaths > death).sum())
            count = len(set(subject.engine.components(points, float(death)).tolist()))
            found = f"{count} components of {name}"
            yield from expect(alive[0] <= count <= alive[1], f"{alive[1]} components at the death {death:g} m", found)


@check
def components_only_merge_as_the_radius_grows(subject: EngineUnderTest) -> Faults:
    """TopologyEngine.components: a filtration, so what is together at a radius is together at every larger one."""
    for name, points in point_sets():
        radii = sorted(clear_radii(points))
        for small, large in pairwise(radii):
            fine, coarse = (partition(subject.engine.components(points, radius)) for radius in (small, large))
            apart = [sorted(part) for part in fine if not any(part <= whole for whole in coarse)]
            yield from expect(not apart, f"{name}: together at {large:g} m what is at {small:g} m", f"apart: {apart}")


@check
def engines_are_stateless(subject: EngineUnderTest) -> Faults:
    """TopologyEngine: stateless, so the same points give the same bits whatever was asked before."""
    first = [(subject.engine.diagram(points), _labels(subject, points)) for _, points in point_sets()]
    again = [(subject.engine.diagram(points), _labels(subject, points)) for _, points in reversed(list(point_sets()))]
    for (name, _), before, after in zip(point_sets(), first, reversed(again), strict=True):
        yield from expect_equal(after[0], before[0], f"the same diagram of {name} as before")
        yield from expect_equal(after[1], before[1], f"the same components of {name} as before")


@check
def points_are_not_changed(subject: EngineUnderTest) -> Faults:
    """Data is immutable: an engine neither writes to the points nor needs them to be writable."""
    for name, points in point_sets():
        writable = points.copy()
        subject.engine.diagram(writable)
        subject.engine.components(writable, 0.1)
        yield from expect(writable.tobytes() == points.tobytes(), f"{name} as they were", "other numbers")


def _moved(points: FloatArray) -> Iterator[tuple[FloatArray, str]]:
    yield points @ rotation_matrix(0.7).T, "turned"
    yield points + np.array([0.4, -0.3]), "shifted"
    yield points * np.array([-1.0, 1.0]), "mirrored"


def _same_deaths(diagram: PersistenceDiagram, deaths: FloatArray, what: str) -> Faults:
    # Points that coincide may come apart by rounding: bars of (nearly) no length do not count.
    found, wanted = (bars[bars > DIAGRAM] for bars in (diagram.finite_deaths, deaths))
    yield from expect_close(found, wanted, DIAGRAM * (1.0 + float(wanted.max(initial=0.0))), what)


def _same_labels(found: IntArray, wanted: IntArray, what: str) -> Faults:
    yield from expect_equal(found.tolist(), wanted.tolist(), what)


def _labels(subject: EngineUnderTest, points: FloatArray) -> list[int]:
    return [int(label) for label in subject.engine.components(points, 0.1)]


TOPOLOGY_CHECKS: tuple[Check[EngineUnderTest], ...] = (
    diagrams_are_well_formed,
    no_points_and_one_point_have_diagrams,
    no_points_have_no_components,
    deaths_are_edges_of_the_minimum_spanning_tree,
    order_of_points_does_not_matter,
    moving_all_points_does_not_matter,
    scaling_the_points_scales_the_deaths,
    components_are_those_of_single_linkage,
    components_agree_with_the_diagram,
    components_only_merge_as_the_radius_grows,
    engines_are_stateless,
    points_are_not_changed,
)
