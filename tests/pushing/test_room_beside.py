"""Where a straight corridor leaves no room between it and the wall next to the target, the angled one is taken instead."""

from __future__ import annotations

import numpy as np
import pytest

from phframe.core import Action, ActionKind, Infeasible, Motion, Scene, Shelf, State, Transition
from phframe.pushing import Corridor, Deviation, Pushing, PushingOptions, PushProblem, find_corridor
from phframe.pushing.corridor import with_room
from tests.pushing.parts import HALF_WIDTH, RADIUS, SHELF, mirrored, scene_of
from tests.pushing.test_clearing import grasped, moved, plan, stays, task_of

NEAR = scene_of((0.45, 0.46), (0.2, 0.5), (0.3, 0.3))
"""The target 14 cm from the north wall, w + 2 cm; o0 on that wall's side of it, with no room outside the corridor."""


def problem(scene: Scene, **options: object) -> PushProblem:
    task = task_of(scene, stays)
    found = Pushing(task, PushingOptions.parse(options, "pushing")).problem(task.start)
    assert not isinstance(found, Infeasible)
    return found


@pytest.mark.parametrize("scene", [NEAR, mirrored(NEAR)])
def test_what_has_no_room_at_the_wall_is_seen_in_the_angled_corridor(scene: Scene) -> None:
    found = problem(scene)
    target = np.array(scene.objects[0].position)
    assert found.deviations == (Deviation.ANGLED_EARLY,)
    assert found.corridor.beside == ("north" if target[1] > 0.3 else "south")
    end, axis = found.corridor.to_local(target)
    assert (end, axis) == pytest.approx((found.corridor.end, found.corridor.axis))
    assert [scene.ids[row] for row in found.members] == ["o1"]


def test_the_papers_sweeps_keep_the_papers_corridor() -> None:
    found = problem(NEAR, sweeps="paper")
    assert (found.deviations, found.corridor.angle) == ((), 0.0)
    assert [NEAR.ids[row] for row in found.members] == ["o0"]


@pytest.mark.parametrize(
    "scene",
    [
        scene_of((0.45, 0.46)),
        scene_of((0.45, 0.46), (0.2, 0.455)),
        scene_of((0.45, 0.6 - HALF_WIDTH - RADIUS - 0.001), (0.2, 0.5)),
    ],
    ids=["nothing in it", "only on the other side of the target", "room for it at the wall"],
)
def test_otherwise_the_corridor_is_the_papers(scene: Scene) -> None:
    found = problem(scene)
    assert found.deviations == ()
    assert found.corridor == find_corridor(np.array(scene.objects[0].position), SHELF, HALF_WIDTH)


def test_a_target_nearer_than_w_to_the_corner_keeps_the_straight_corridor() -> None:
    """From the corner that the angled corridor would begin at; only in a shelf hardly wider than the corridor."""
    shelf, straight = Shelf(depth=0.6, width=0.21), Corridor(np.zeros(2), 0.0, 0.11, HALF_WIDTH, 0.0, 0.03)
    assert with_room(straight, shelf, np.array([[0.01, 0.12]]), np.array([RADIUS])) is straight


def test_every_push_and_the_grasp_along_it_count_the_deviation() -> None:
    def answer(state: State, action: Action) -> Transition:
        pushed = Transition(moved(state, 2, (0.0, -0.25)), Motion(1.0))
        return grasped(state, action) if action.kind is ActionKind.GRASP else pushed

    found = plan(NEAR, answer)
    assert [action.moves for action in found.actions] == [("o1",), ("target",)]
    assert found.deviations[Deviation.ANGLED_EARLY] == 2
