"""The groups that may be pushed from one state: each once, larger ones at larger radii, PHIA's where that is asked for."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from phframe.core import Infeasible
from phframe.pushing import Deviation, ObstacleGroup, PushProblem, closest_component, closest_groups
from phframe.runtime.scenes import find_scene
from tests.planners.solved import PUBLISHED
from tests.pushing.parts import often, scene_of
from tests.pushing.worlds import Bench, bench

GRID = [(0.1 + 0.065 * row, 0.18 + 0.065 * column) for row in range(4) for column in range(4)]
obstacles = st.lists(st.sampled_from(GRID), min_size=1, max_size=9, unique=True)


def problem_of(made: Bench) -> PushProblem | None:
    found = made.pushing.problem(made.task.start)
    assert not isinstance(found, Infeasible)
    return found if len(found.members) else None


def members(group: ObstacleGroup) -> tuple[int, ...]:
    return tuple(group.chosen.tolist())


def first_alone(problem: PushProblem) -> int:
    """The member nearest to the gripper, of several the one nearest to the axis."""
    local, axis = problem.local, problem.corridor.axis
    return min(range(len(local)), key=lambda row: (local[row, 0], abs(local[row, 1] - axis)))


@often
@given(obstacles)
def test_each_group_is_there_once_and_holds_what_is_closest(places: list[tuple[float, float]]) -> None:
    with bench(scene_of((0.5, 0.3), *places)) as made:
        problem = problem_of(made)
        if problem is None:
            return
        groups = closest_groups(made.pushing, problem, "homology", "all")
        assert len({members(group) for group in groups}) == len(groups)
        nearest = first_alone(problem)
        assert all(nearest in members(group) for group in groups)
        assert (nearest,) in {members(group) for group in groups}, "the closest object alone is one of them"


@often
@given(obstacles)
@example([(0.1, 0.3), (0.162, 0.3), (0.237, 0.3), (0.307, 0.3)])  # closer than the threshold, and not alike
def test_groups_are_made_at_usable_radii_the_threshold_and_where_all_are_one(places: list[tuple[float, float]]) -> None:
    with bench(scene_of((0.5, 0.3), *places)) as made:
        problem = problem_of(made)
        if problem is None:
            return
        diagram, groups = made.pushing.diagram(problem), closest_groups(made.pushing, problem, "homology", "all")
        all_one = max(diagram.finite_deaths.tolist(), default=0.0)
        allowed = {*made.pushing.radii(diagram), made.pushing.threshold, all_one}
        assert {group.radius for group in groups if group.radius} <= allowed


@often
@given(obstacles)
def test_a_group_at_a_larger_radius_holds_those_at_smaller_ones(places: list[tuple[float, float]]) -> None:
    with bench(scene_of((0.5, 0.3), *places)) as made:
        problem = problem_of(made)
        if problem is None:
            return
        groups = sorted(closest_groups(made.pushing, problem, "homology", "all"), key=lambda group: group.radius)
        for smaller, larger in pairwise(groups):
            assert set(members(smaller)) < set(members(larger))


@often
@given(obstacles)
def test_each_group_is_the_component_at_its_radius_and_every_radius_that_counts_is_looked_at(
    places: list[tuple[float, float]],
) -> None:
    with bench(scene_of((0.5, 0.3), *places)) as made:
        problem = problem_of(made)
        if problem is None:
            return
        pushing, groups = made.pushing, closest_groups(made.pushing, problem, "homology", "all")
        found = {members(group) for group in groups}
        diagram = pushing.diagram(problem)
        for radius in (*pushing.radii(diagram), pushing.threshold, *diagram.finite_deaths[-1:].tolist()):
            labels = pushing.components(problem, radius)
            assert tuple(closest_component(problem.local, labels, problem.corridor.axis).tolist()) in found
        for group in groups:
            if group.labels is not None:
                assert (group.labels == pushing.components(problem, group.radius)).all()
                assert (group.labels[group.chosen] == group.labels[group.chosen[0]]).all()


def test_the_last_death_joins_all_and_is_one_of_them() -> None:
    """Where no usable radius does so."""
    row = scene_of((0.5, 0.3), (0.1, 0.3), (0.2, 0.3), (0.3, 0.3))
    with bench(row) as made:
        problem = problem_of(made)
        assert problem is not None
        assert {members(group) for group in closest_groups(made.pushing, problem, "homology", "all")} == {
            (0,),
            (0, 1, 2),
        }


def test_single_is_the_closest_object_alone() -> None:
    with bench(scene_of((0.5, 0.3), (0.2, 0.3), (0.2, 0.361), (0.15, 0.25))) as made:
        problem = problem_of(made)
        assert problem is not None
        [group] = closest_groups(made.pushing, problem, "single", "all")
        assert members(group) == (first_alone(problem),)
        assert (group.radius, group.diagram, group.labels) == (0.0, None, None)
        for push in made.pushing.sweeps(problem, group.chosen):
            told = group.told_in(push[0])
            assert (told.why, told.radius) == ("the closest obstacle", push[0].radius)


@pytest.mark.parametrize("name", PUBLISHED[::4])
def test_the_smallest_radius_is_the_one_of_phia(name: str) -> None:
    with bench(find_scene(name)) as made:
        problem = problem_of(made)
        if problem is None:
            return
        [group] = closest_groups(made.pushing, problem, "homology", "smallest")
        first = next(iter(made.pushing.pushes_at_all_radii(problem)), None)
        assert first is not None
        for decision, action in first:
            assert group.radius == decision.radius
            told = next(made.pushing.sweeps(problem, group.chosen))
            assert told[1].path.poses.tobytes() == action.path.poses.tobytes()
            assert (group.told_in(told[0]).radius, group.told_in(told[0]).why) == (decision.radius, decision.why)
            assert (Deviation.FALLBACK_RADIUS in decision.deviations) == (group.radius == made.pushing.threshold)
            break
