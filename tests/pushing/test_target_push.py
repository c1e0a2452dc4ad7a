"""Pushes of the target itself: the target is what they mean to move, aside by what they say, and all of them fit."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import ActionKind, FloatArray
from phframe.planners.sure import SureOptions
from phframe.pushing import PushSearch, target_pushes
from phframe.pushing.target_push import ANGLES, DISTANCES
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import ARM, gap_to_walls, mirrored, rejections, scene_of
from tests.pushing.worlds import Bench, bench, task_in

targets = st.tuples(st.floats(0.1, 0.5), st.floats(0.032, 0.568))


def pushes(made: Bench) -> list[tuple[float, float, int, FloatArray]]:
    """Distance, angle, direction and path of each, in their order."""
    found: list[tuple[float, float, int, FloatArray]] = []
    radius = float(made.pushing.scene.radii[made.pushing.scene.target_index])
    for decision, action in target_pushes(made.pushing, made.task.start):
        assert decision.corridor is not None
        assert decision.sweep is not None
        distance = decision.corridor.half_width + radius
        found.append((distance, decision.corridor.angle, decision.sweep.direction, action.path.poses))
    return found


@settings(max_examples=12, deadline=None)
@given(targets)
def test_they_push_nothing_but_the_target_at_the_angles_and_distances_that_are_looked_at(
    target: tuple[float, float],
) -> None:
    with bench(scene_of(target)) as made:
        for decision, action in target_pushes(made.pushing, made.task.start):
            assert (action.kind, action.moves, decision.chosen) == (ActionKind.PUSH, ("target",), ("target",))
        for distance, angle, _, _ in pushes(made):
            assert min(abs(distance - each) for each in DISTANCES) < 1e-9
            assert angle in ANGLES
        assert [distance for distance, *_ in pushes(made)] == sorted(distance for distance, *_ in pushes(made))


@settings(max_examples=6, deadline=None)
@given(targets)
def test_the_arm_keeps_clear_of_the_walls(target: tuple[float, float]) -> None:
    with bench(scene_of(target)) as made:
        for *_, poses in pushes(made):
            for begin, end in pairwise(poses):
                for share in (0.0, 0.5, 1.0):
                    assert gap_to_walls(ARM.closed, begin + share * (end - begin)) >= 0.0


@settings(max_examples=12, deadline=None)
@given(targets)
def test_north_and_south_are_alike(target: tuple[float, float]) -> None:
    scene = scene_of(target)
    with bench(scene) as made, bench(mirrored(scene)) as other:
        ours = sorted((round(d, 6), round(angle, 6), way) for d, angle, way, _ in pushes(made))
        theirs = sorted((round(d, 6), round(-angle, 6) + 0.0, -way) for d, angle, way, _ in pushes(other))
    assert ours == theirs


@pytest.mark.parametrize(("y", "away"), [(0.04, 1), (0.56, -1)], ids=["south", "north"])
def test_at_a_wall_one_of_them_moves_the_target_away_from_it(y: float, away: int) -> None:
    scene = scene_of((0.45, y))
    with bench(scene) as made:
        shifts = []
        for _, action in target_pushes(made.pushing, made.task.start):
            after = made.task.apply(made.task.start, action)
            if after.motion.complete:
                shifts.append(float(after.state.positions[0, 1]) - y)
        assert max(away * shift for shift in shifts) > 0.02


def test_in_the_open_each_moves_the_target_by_about_what_it_says() -> None:
    with bench(scene_of((0.35, 0.3))) as made:
        seen = set()
        for (distance, angle, way, _), (_, action) in zip(
            pushes(made), target_pushes(made.pushing, made.task.start), strict=True
        ):
            after = made.task.apply(made.task.start, action)
            by = after.state.positions[0] - made.task.start.positions[0]
            across = way * float(by @ [-math.sin(angle), math.cos(angle)])
            assert across == pytest.approx(distance, abs=0.012)
            seen.add((round(distance, 3), way))
        assert seen == {(distance, way) for distance in DISTANCES for way in (1, -1)}


def test_what_was_rejected_is_left_out() -> None:
    scene = scene_of((0.35, 0.3))
    with PlanningWorld(WorldSpec(scene)) as world:
        first = PushSearch(task_in(world), SureOptions()).pushing
        whole = [action for _, action in target_pushes(first, scene.initial_state())]
        rest = PushSearch(task_in(world, rejected=rejections(whole[:1])), SureOptions()).pushing
        left = [action for _, action in target_pushes(rest, scene.initial_state())]
    assert len(whole) > len(left)
    assert not any(action.resembles(whole[0]) for action in left)
