"""Which obstacles count in a state, and the decisions made about them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import Condition, Cylinder, FloatArray, Infeasible, Scene
from phframe.pushing import Pushing, PushingOptions, PushProblem
from phframe.testing import simulated_tasks
from tests.pushing.parts import RADIUS, in_strip, mirrored, often, scene_of

SCENE = scene_of((0.45, 0.3), (0.2, 0.3), (0.3, 0.4), (0.3, 0.5), (0.5, 0.36))
tasks = simulated_tasks()


def pushing(scene: Scene = SCENE, **options: float) -> Pushing:
    return Pushing(tasks(scene), PushingOptions(**options))


def names(problem: PushProblem | Infeasible, scene: Scene = SCENE) -> list[str]:
    assert isinstance(problem, PushProblem)
    return [scene.ids[row] for row in problem.members]


def test_obstacles_in_the_corridor_count_and_the_target_does_not() -> None:
    assert names(pushing().problem(SCENE.initial_state())) == ["o0", "o1"]


def test_what_blocks_the_grasp_counts_too() -> None:
    assert names(pushing().problem(SCENE.initial_state(), ("o3", "target"))) == ["o0", "o1", "o3"]


def test_what_has_spilled_does_not_count_and_what_has_toppled_does() -> None:
    state = SCENE.initial_state()
    upright, spilled, toppled = Condition.UPRIGHT, Condition.SPILLED, Condition.TOPPLED
    changed = replace(state, conditions=(upright, spilled, toppled, upright, upright))
    assert names(pushing().problem(changed, ("o0",))) == ["o1"]


@pytest.mark.parametrize("condition", [Condition.SPILLED, Condition.TOPPLED])
def test_a_target_that_does_not_stand_has_no_corridor(condition: Condition) -> None:
    state = SCENE.initial_state()
    refused = pushing().problem(replace(state, conditions=(condition, *state.conditions[1:])))
    assert refused == Infeasible(f"the target 'target' is {condition}")


def test_the_corridor_follows_the_target() -> None:
    poses = SCENE.initial_state().poses.copy()
    poses[0, 1] += 0.1
    moved = pushing().problem(replace(SCENE.initial_state(), poses=poses))
    assert isinstance(moved, PushProblem)
    assert moved.corridor.axis == pytest.approx(0.4)
    assert names(moved) == ["o0", "o1", "o2"]


@often
@given(st.lists(st.tuples(st.integers(1, 9), st.integers(1, 9)), min_size=2, max_size=9, unique=True))
def test_members_are_those_in_the_strip_given_in_its_frame(cells: list[tuple[int, int]]) -> None:
    """The first is the target, anywhere in the shelf: straight corridors and angled ones."""
    target, *others = [(0.061 * x, 0.061 * y) for x, y in cells]
    scene = scene_of(target, *others)
    problem = pushing(scene).problem(scene.initial_state())
    assert isinstance(problem, PushProblem)
    inside = in_strip(problem.corridor, np.array(target), np.array(others))
    assert names(problem, scene) == [f"o{number}" for number in np.flatnonzero(inside)]
    np.testing.assert_array_equal(problem.local, problem.corridor.to_local(np.array(others)[inside]))


def test_the_largest_obstacle_sets_the_threshold_whatever_the_target() -> None:
    fat = replace(SCENE, objects=(replace(SCENE.objects[0], shape=Cylinder(0.05)), *SCENE.objects[1:4]))
    assert pushing(fat).threshold == pytest.approx(1.1 * 0.018 + 0.06)
    large = replace(SCENE, objects=(*SCENE.objects[:4], replace(SCENE.objects[4], shape=Cylinder(0.031))))
    assert pushing(large, insertion_width=0.05).threshold == pytest.approx(1.1 * 0.05 + 0.062)
    assert pushing(scene_of((0.4, 0.3))).threshold == pytest.approx(1.1 * 0.018)


def test_decisions_say_what_was_seen_and_rejected_actions_are_left_out() -> None:
    every = pushing()
    problem = every.problem(SCENE.initial_state())
    assert isinstance(problem, PushProblem)
    diagram = every.diagram(problem)
    proposals = list(every.pushes(problem, diagram, 0.2, ("because",)))
    assert len(proposals) >= 2
    for decision, action in proposals:
        assert decision.members == decision.chosen == action.moves == ("o0", "o1")
        assert (decision.radius, decision.diagram, decision.corridor) == (0.2, diagram, problem.corridor)
        assert decision.labels is not None
        assert decision.labels.tolist() == [0, 0]
        assert decision.deviations[0] == "because"
    singles = list(every.pushes(problem, diagram, 0.01))
    assert {decision.chosen for decision, _ in singles} == {("o0",)}
    rejected = tasks(SCENE, rejected=(proposals[0][1],))
    rest = list(Pushing(rejected, PushingOptions()).pushes(problem, diagram, 0.2, ("because",)))
    assert rest == proposals[1:]


def test_the_mirrored_scene_has_the_same_members() -> None:
    other = mirrored(SCENE)
    assert names(pushing(other).problem(other.initial_state()), other) == ["o0", "o1"]


class Bar(Cylinder):
    """Stands for two points, 5 cm to one side of its centre and 4 cm to the other."""

    __slots__ = ()

    @property
    def landmarks(self) -> FloatArray:
        return np.array([[-0.05, 0.0], [0.04, 0.0]])


@pytest.mark.parametrize("target", [(0.45, 0.3), (0.45, 0.53), (0.45, 0.07)], ids=["straight", "north", "south"])
def test_objects_are_grouped_by_their_landmarks_turned_as_they_stand(target: tuple[float, float]) -> None:
    """One bar across the mouth, the other pointing at its middle: their points are 5 cm by 5 or 4 cm apart."""
    plain = scene_of(target, (0.2, 0.3), (0.3, 0.3))
    across = replace(plain.objects[1], shape=Bar(RADIUS), yaw=math.pi / 2.0)
    scene = replace(plain, objects=(plain.objects[0], across, replace(plain.objects[2], shape=Bar(RADIUS))))
    made = pushing(scene)
    problem = made.problem(scene.initial_state(), ("o0", "o1"))
    assert isinstance(problem, PushProblem)
    assert (problem.corridor.angle == 0.0) is (target[1] == 0.3)
    near = math.hypot(0.05, 0.04)
    assert made.diagram(problem).finite_deaths.tolist() == pytest.approx([near, math.hypot(0.05, 0.05), 0.09])
    labels = [made.components(problem, radius).tolist() for radius in (near - 0.002, near + 0.002)]
    assert labels == [[0, 1], [0, 0]]
