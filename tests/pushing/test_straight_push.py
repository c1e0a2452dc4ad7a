"""A straight push begins behind the object, ends with the object at its place, and keeps the arm off the walls."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from phframe.bench.meters.tasks import retrieval_task
from phframe.core import Action, Condition, FloatArray, Infeasible, InputError, Phase, Scene
from phframe.pushing import Pushing, StraightDrive, StraightPusher, StraightPushOptions, straight_drive
from phframe.pushing.straight_push import outside_shelf
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import ARM, RADIUS, SHELF, gap_to_walls, often, scene_of

OPTIONS = StraightPushOptions()
TARGET = (0.5, 0.3)


@contextmanager
def pushers(scene: Scene, options: StraightPushOptions = OPTIONS) -> Iterator[tuple[Pushing, StraightPusher]]:
    """A scene's task in pymunk, and what pushes in it."""
    with PlanningWorld(WorldSpec(scene)) as world:
        pushing = Pushing(retrieval_task(world), options.pushing)
        yield pushing, StraightPusher(pushing, options)


def places_of(scene: Scene, name: str, options: StraightPushOptions = OPTIONS) -> tuple[FloatArray, StraightDrive]:
    with pushers(scene, options) as (pushing, pusher):
        drive = straight_drive(pushing, pushing.task.start)
        assert isinstance(drive, StraightDrive)
        return pusher.free_places(pushing.task.start, scene.index(name), drive, 0.03), drive


@pytest.mark.parametrize("name", ["vieira/basic", "papallas/s01", "random/3"])
def test_free_places_are_apart_from_all_others_and_leave_the_way_free(name: str) -> None:
    scene = find_scene(name)
    for row, blocker in enumerate(scene.ids):
        if blocker == scene.target:
            continue
        places, drive = places_of(scene, blocker)
        assert len(places)
        others = np.delete(scene.initial_state().positions, row, axis=0)
        apart = np.linalg.norm(places[:, None] - others, axis=2).min()
        assert apart >= 0.07 - 1e-9
        assert not drive.grasp.corridor.contains(places).any()
        assert not drive.meets(places, RADIUS).any()
        assert places.min() >= RADIUS
        assert (places <= [scene.shelf.depth - RADIUS, scene.shelf.width - RADIUS]).all()
        assert (np.linalg.norm(places - scene.initial_state().positions[row], axis=1) > OPTIONS.goal_radius).all()


def test_places_are_on_the_grid_and_none_that_is_free_is_left_out() -> None:
    places, _ = places_of(scene_of((0.5, 0.31), (0.2, 0.3)), "o0")
    steps = (places - RADIUS) / 0.03
    assert np.allclose(steps, steps.round())
    aside = places[:, 1] > 0.31 + 0.12
    assert aside.sum() == 19 * 5  # x from 0.03 to 0.57, y from 0.45 to 0.57
    fewer, _ = places_of(scene_of((0.5, 0.31), (0.2, 0.3), (0.3, 0.51)), "o0")
    gone = places[np.linalg.norm(places - [0.3, 0.51], axis=1) < 0.07]
    assert len(gone)
    assert len(fewer) == len(places) - len(gone)


def test_what_has_spilled_takes_no_place() -> None:
    scene = scene_of(TARGET, (0.2, 0.3), (0.3, 0.5))
    with pushers(scene) as (pushing, pusher):
        start = pushing.task.start
        spilled = replace(start, conditions=(Condition.UPRIGHT, Condition.UPRIGHT, Condition.SPILLED))
        at = np.array([0.3, 0.5])
        assert "o1" in pusher.refusal(start, 1, at)
        assert not pusher.refusal(spilled, 1, at)
        assert "left the board" in pusher.refusal(spilled, 2, np.array([0.1, 0.1]))


@pytest.mark.parametrize(
    ("x", "y", "ok"), [(0.03, 0.03, True), (0.57, 0.57, True), (0.029, 0.3, False), (0.3, 0.571, False), (-1, 0, False)]
)
def test_places_outside_the_shelf_are_told_with_what_is_inside(x: float, y: float, ok: bool) -> None:
    why = outside_shelf(scene_of(TARGET, (0.2, 0.3)), 1, np.array([x, y]))
    assert (why == "") is ok
    assert ok or "x from 0.03 to 0.57, y from 0.03 to 0.57" in why


@often
@given(st.floats(0.08, 0.5), st.floats(0.08, 0.52), st.floats(0.05, 0.55), st.floats(0.05, 0.55), st.floats(-0.5, 0.5))
def test_a_push_begins_behind_and_ends_with_the_object_at_its_place(
    x: float, y: float, to_x: float, to_y: float, yaw: float
) -> None:
    assume(math.dist((x, y), (to_x, to_y)) > 0.05)
    assume(math.dist((x, y), TARGET) > 0.061)
    with pushers(scene_of(TARGET, (x, y))) as (pushing, pusher):
        at, place = np.array([x, y]), np.array([to_x, to_y])
        action = pusher.push(pushing.task.start, 1, place, yaw)
        if isinstance(action, Infeasible):
            assert "o0 cannot be pushed straight" in action.reason
            return
        poses = action.path.poses
        assert action.path.phases == (Phase.INSERT, Phase.SWEEP, Phase.RETREAT)
        assert (poses[:, 2] == yaw).all()
        begin, end = poses[1, :2], poses[2, :2]
        along = (place - at) / math.dist(place, at)
        assert np.allclose(begin, at - 2.1 * RADIUS * along)
        gap = math.dist(end, place)
        between = math.atan2(to_y - y, to_x - x) - yaw  # seen along the push, the arm is so wide as it is askew
        assert gap == pytest.approx(RADIUS + ARM.insertion_width / 2 * abs(math.sin(between)))
        assert np.allclose((place - end) / gap, along)
        for pose in np.concatenate([np.linspace(a, b, 9) for a, b in pairwise(poses)]):
            assert gap_to_walls(ARM.closed, pose) > OPTIONS.wall_clearance - 1e-6


@pytest.mark.parametrize("to", [(0.3, 0.3), (0.25, 0.5), (0.15, 0.1), (0.3, 0.35)])
def test_an_object_alone_gets_to_its_place(to: tuple[float, float]) -> None:
    with pushers(scene_of((0.5, 0.1), (0.15, 0.3))) as (pushing, pusher):
        action = pusher.push(pushing.task.start, 1, np.array(to), 0.0)
        assert isinstance(action, Action)
        after = pushing.task.apply(pushing.task.start, action).state
        assert pusher.is_there(after, 1, np.array(to))


def test_what_must_be_met_on_the_way_behind_it_cannot_be_pushed_out() -> None:
    with pushers(scene_of(TARGET, (0.3, 0.3))) as (pushing, pusher):
        action = pusher.push(pushing.task.start, 1, np.array([0.1, 0.3]), 0.0)
    assert isinstance(action, Infeasible)
    assert "cannot get behind it without touching it" in action.reason


def test_what_stands_at_a_wall_cannot_be_pushed_off_it() -> None:
    with pushers(scene_of(TARGET, (0.3, 0.035))) as (pushing, pusher):
        action = pusher.push(pushing.task.start, 1, np.array([0.3, 0.3]), 0.0)
    assert isinstance(action, Infeasible)
    assert "wall" in action.reason
    assert SHELF.width == 0.6


def test_the_figures_in_common_with_the_papers_method_are_handed_on() -> None:
    options = StraightPushOptions(half_width=0.1, withdrawal=0.2, reach_speed=0.1)
    assert (options.pushing.half_width, options.pushing.withdrawal, options.pushing.reach_speed) == (0.1, 0.2, 0.1)


@pytest.mark.parametrize("half_width", [0.0, 1.1])
def test_a_corridor_of_no_width_or_wider_than_two_metres_is_refused(half_width: float) -> None:
    assert StraightPushOptions(half_width=1.0).half_width == 1.0
    with pytest.raises(InputError, match="half_width"):
        StraightPushOptions.parse({"half_width": half_width}, "mine")
