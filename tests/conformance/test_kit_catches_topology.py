"""Every check of topology engines finds an engine that breaks its promise."""

from __future__ import annotations

import numpy as np
import pytest

from phframe.core import FloatArray, IntArray, Options, PersistenceDiagram
from phframe.testing import TOPOLOGY_CHECKS, Check, ConformanceError, EngineUnderTest, check_topology
from phframe.topology.single_linkage import SingleLinkage


class WithoutTheInfiniteBar(SingleLinkage):
    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        deaths = super().diagram(points).finite_deaths
        return PersistenceDiagram(np.zeros(len(deaths)), deaths)


class HalfTheDistances(SingleLinkage):
    """Deaths as radii of balls rather than distances."""

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        found = super().diagram(points)
        return PersistenceDiagram(found.births, found.deaths / 2.0)


class InTheOrderOfThePoints(SingleLinkage):
    """Joins each point to the one before it only."""

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        deaths = np.append(np.sort(steps[steps > 0.0]), [np.inf] * bool(len(points)))
        return PersistenceDiagram(np.zeros(len(deaths)), deaths)


class Astigmatic(SingleLinkage):
    """Distances across count half."""

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        return super().diagram(points * [1.0, 0.5])


class Centimetres(SingleLinkage):
    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        found = super().diagram(points)
        return PersistenceDiagram(found.births, np.round(found.deaths, 2))


class FailsOnNothing(SingleLinkage):
    def components(self, points: FloatArray, radius: float) -> IntArray:
        return super().components(points, radius) + 0 * int(points[0, 0])


class LabelsBackwards(SingleLinkage):
    def components(self, points: FloatArray, radius: float) -> IntArray:
        labels = super().components(points, radius)
        return np.asarray(labels.max(initial=0) - labels)


class OneMoreComponent(SingleLinkage):
    def components(self, points: FloatArray, radius: float) -> IntArray:
        labels = super().components(points, radius)
        labels[-1:] = labels.max(initial=-1) + 1
        return labels


class SplitsAgain(SingleLinkage):
    """At large radii every point stands alone."""

    def components(self, points: FloatArray, radius: float) -> IntArray:
        return np.arange(len(points)) if radius > 0.2 else super().components(points, radius)


class Remembers(SingleLinkage):
    def __init__(self, options: Options) -> None:
        super().__init__(options)
        self.asked = 0

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        self.asked += 1
        found = super().diagram(points)
        return PersistenceDiagram(found.births, found.deaths * (1.0 + 1e-15 * self.asked))


class SortsInPlace(SingleLinkage):
    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        if points.flags.writeable:
            points.sort(axis=0)
        return super().diagram(points)


BROKEN: dict[str, type[SingleLinkage]] = {
    "diagrams_are_well_formed": WithoutTheInfiniteBar,
    "no_points_and_one_point_have_diagrams": WithoutTheInfiniteBar,
    "no_points_have_no_components": FailsOnNothing,
    "deaths_are_edges_of_the_minimum_spanning_tree": HalfTheDistances,
    "order_of_points_does_not_matter": InTheOrderOfThePoints,
    "moving_all_points_does_not_matter": Astigmatic,
    "scaling_the_points_scales_the_deaths": Centimetres,
    "components_are_those_of_single_linkage": LabelsBackwards,
    "components_agree_with_the_diagram": OneMoreComponent,
    "components_only_merge_as_the_radius_grows": SplitsAgain,
    "engines_are_stateless": Remembers,
    "points_are_not_changed": SortsInPlace,
}


@pytest.mark.parametrize("check", TOPOLOGY_CHECKS, ids=lambda check: check.name)
def test_every_check_can_fail(check: Check[EngineUnderTest]) -> None:
    engine = BROKEN[check.name](Options())
    with pytest.raises(ConformanceError) as caught:
        check(EngineUnderTest(engine))
    assert caught.value.failures[0].check == check.name
    crashed = "no exception" in str(caught.value)
    assert crashed is (BROKEN[check.name] is FailsOnNothing)


def test_all_failures_are_told_at_once() -> None:
    with pytest.raises(ConformanceError) as caught:
        check_topology(WithoutTheInfiniteBar(Options()))
    failed = [failure.check for failure in caught.value.failures]
    assert failed == [
        "diagrams_are_well_formed",
        "no_points_and_one_point_have_diagrams",
        "components_agree_with_the_diagram",
    ]


def test_a_good_engine_passes() -> None:
    report = check_topology(SingleLinkage(Options()))
    assert report.passed == tuple(check.name for check in TOPOLOGY_CHECKS)
    assert report.not_applicable == ()
