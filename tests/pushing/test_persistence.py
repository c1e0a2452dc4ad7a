"""Persistent and usable radii, and the figures that the specification gives for the published scenes."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import FloatArray, PersistenceDiagram, Scene
from phframe.pushing import (
    Pushing,
    PushingOptions,
    PushProblem,
    persistent_radii,
    usable_radii,
    usable_threshold,
)
from phframe.runtime.scenes import find_scene, scene_names
from phframe.testing import simulated_tasks
from tests.pushing.parts import often

deaths = st.lists(st.floats(0.0, 1.0), max_size=12).map(lambda values: np.array(sorted(values)))
PUBLISHED = [name for name in scene_names() if name.startswith(("vieira", "papallas"))]


def seen(scene: Scene, **options: float) -> tuple[Pushing, PushProblem, PersistenceDiagram]:
    """A scene at its start, in the corridor of Algorithm 1."""
    pushing = Pushing(simulated_tasks()(scene), PushingOptions(sweeps="paper", **options))
    problem = pushing.problem(scene.initial_state())
    assert isinstance(problem, PushProblem)
    return pushing, problem, pushing.diagram(problem)


@often
@given(deaths, st.floats(0.0, 0.2))
def test_a_death_persists_where_the_next_is_farther_than_the_margin(values: FloatArray, margin: float) -> None:
    persistent = persistent_radii(values, margin).tolist()
    wanted = [d for d, after in pairwise([*values, np.inf]) if after - d > margin]
    assert persistent == wanted


@often
@given(deaths, st.floats(0.0, 0.2), st.floats(0.0, 1.0))
def test_the_last_death_persists_and_usable_ones_exceed_the_threshold(
    values: FloatArray, margin: float, threshold: float
) -> None:
    persistent, usable = persistent_radii(values, margin), usable_radii(values, margin, threshold)
    assert len(persistent) == 0 if len(values) == 0 else persistent[-1] == values[-1]
    assert usable.tolist() == [radius for radius in persistent if radius > threshold]


def test_a_gap_of_exactly_the_margin_and_a_radius_of_exactly_the_threshold_do_not_count() -> None:
    values = np.array([0.25, 0.5, 1.0])
    assert persistent_radii(values, 0.25).tolist() == [0.5, 1.0]
    assert usable_radii(values, 0.25, 0.5).tolist() == [1.0]


def test_the_paper_threshold_is_an_insertion_width_of_18_mm() -> None:
    assert usable_threshold(0.018, 0.03) == pytest.approx(0.08, abs=5e-4)
    assert usable_threshold(0.0, 0.03) == pytest.approx(0.06)


def test_the_test_vectors_of_basic() -> None:
    pushing, problem, diagram = seen(find_scene("vieira/basic"))
    assert (len(problem.members), problem.corridor.half_width) == (7, 0.12)
    np.testing.assert_allclose(
        diagram.finite_deaths, [0.0641, 0.0840, 0.0857, 0.1127, 0.1172, 0.1213], atol=5.1e-5, rtol=0
    )
    persistent = persistent_radii(diagram.finite_deaths, 0.015)
    np.testing.assert_allclose(persistent, [0.0641, 0.0857, 0.1213], atol=5.1e-5, rtol=0)
    usable = usable_radii(diagram.finite_deaths, 0.015, pushing.threshold)
    np.testing.assert_allclose(usable, [0.0857, 0.1213], atol=5.1e-5, rtol=0)
    counts = [len(set(pushing.task.components(problem.local, radius).tolist())) for radius in persistent]
    assert counts == [6, 4, 1]


@pytest.mark.parametrize(
    ("insertion_width", "counts"), [(0.018, (1, 13, 17)), (0.044, (7, 14, 10)), (0.1055, (22, 7, 2))]
)
def test_how_much_persistence_can_choose_on_the_31_scenes(insertion_width: float, counts: tuple[int, int, int]) -> None:
    assert len(PUBLISHED) == 31
    usable: Counter[int] = Counter()
    for name in PUBLISHED:
        pushing, _, diagram = seen(find_scene(name), insertion_width=insertion_width)
        usable[min(2, len(usable_radii(diagram.finite_deaths, 0.015, pushing.threshold)))] += 1
    assert (usable[0], usable[1], usable[2]) == counts


def test_the_corridor_is_angled_in_five_scenes() -> None:
    corridors = {name: seen(find_scene(name))[1].corridor for name in PUBLISHED}
    angled = {name: abs(np.degrees(each.angle)) for name, each in corridors.items() if each.beside}
    assert {name.partition("/")[2] for name in angled} == {"s01", "s05", "s08", "example-06", "example-08"}
    assert 30.5 < min(angled.values()) < max(angled.values()) < 43.5
