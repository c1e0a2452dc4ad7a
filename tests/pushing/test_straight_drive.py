"""The straight drive at the target meets first what stands nearest to the mouth in its way, and nothing that stands aside."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.meters.tasks import retrieval_task
from phframe.core import Budget, BudgetExceededError, Condition, Infeasible, Phase, Scene, Shelf, Stop
from phframe.pushing import Pushing, PushingOptions
from phframe.pushing.straight_drive import StraightDrive, first_blocker, straight_drive
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import often, scene_of
from tests.pushing.worlds import task_in

TARGET = (0.4, 0.3)


@contextmanager
def seen(scene: Scene) -> Iterator[Pushing]:
    """A scene's task in pymunk."""
    with PlanningWorld(WorldSpec(scene)) as world:
        yield Pushing(retrieval_task(world), PushingOptions())


def met(scene: Scene) -> str | Infeasible | None:
    with seen(scene) as pushing:
        return first_blocker(pushing, pushing.task.start)


def drive_of(pushing: Pushing) -> StraightDrive:
    drive = straight_drive(pushing, pushing.task.start)
    assert isinstance(drive, StraightDrive)
    return drive


@pytest.mark.parametrize(
    ("obstacles", "first"),
    [
        ([], None),
        ([(0.2, 0.3)], "o0"),
        ([(0.3, 0.3), (0.2, 0.3)], "o1"),
        ([(0.2, 0.3), (0.3, 0.3)], "o0"),
        ([(0.2, 0.42), (0.2, 0.18)], None),  # aside of the link, though not outside the corridor
        ([(0.2, 0.37)], "o0"),  # met by the palm or the link, which are wider than the fingers
        ([(0.4, 0.365)], "o0"),  # beside the target, met by a finger
        ([(0.5, 0.3)], None),  # behind the target
    ],
)
def test_the_first_object_in_the_way_is_the_blocker(obstacles: list[tuple[float, float]], first: str | None) -> None:
    assert met(scene_of(TARGET, *obstacles)) == first


def test_the_drive_costs_one_simulation_and_changes_nothing() -> None:
    with seen(scene_of(TARGET, (0.2, 0.3))) as pushing:
        before = pushing.task.start
        first_blocker(pushing, before)
        assert pushing.task.cost.simulated_actions == 1
        assert (before.positions[1] == [0.2, 0.3]).all()


def test_a_target_near_a_wall_is_driven_at_an_angle_that_the_walls_allow() -> None:
    with seen(find_scene("papallas/s01")) as pushing:
        drive = drive_of(pushing)
        assert drive.tip[2] > math.radians(10.0)
        assert isinstance(first_blocker(pushing, pushing.task.start, drive), str)


def test_what_has_spilled_is_not_met() -> None:
    with seen(scene_of(TARGET, (0.2, 0.3))) as pushing:
        start = pushing.task.start
        spilled = replace(start, conditions=(Condition.UPRIGHT, Condition.SPILLED))
        assert first_blocker(pushing, spilled) is None


def test_why_there_is_no_drive_is_told() -> None:
    wide = met(scene_of((0.4, 0.05), shelf=Shelf(0.6, 0.1)))
    assert isinstance(wide, Infeasible)
    assert "set half_width" in wide.reason


def test_the_budget_is_kept() -> None:
    scene = scene_of(TARGET, (0.2, 0.3))
    with PlanningWorld(WorldSpec(scene)) as world:
        task = task_in(world, budget=Budget(simulations=0))
        with pytest.raises(BudgetExceededError):
            first_blocker(Pushing(task, PushingOptions()), task.start)


@often
@given(st.floats(0.05, 0.55), st.floats(0.04, 0.56))
def test_what_the_region_leaves_out_is_not_touched_in_simulation(x: float, y: float) -> None:
    if math.dist((x, y), TARGET) < 0.061:
        return
    with seen(scene_of(TARGET, (x, y))) as pushing:
        drive = drive_of(pushing)
        motion = pushing.task.apply(pushing.task.start, drive.action, stop=Stop(bodies=frozenset({"o0"}))).motion
        region = bool(drive.meets(np.array([[x, y]]), 0.03)[0])
        assert region or not [contact for contact in motion.contacts if contact.body == "o0"]
        assert drive.action.path.phases == (Phase.REACH,)
