"""Sure: few harmless pushes and a clean grasp, each option as it says, and a reason where there is no plan."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from phframe.core import (
    ROOT,
    ActionKind,
    Assessment,
    Attempt,
    Condition,
    Goal,
    Motion,
    Options,
    Plan,
    Scene,
    State,
    Status,
    Task,
    Transition,
)
from phframe.core.particle import Apply
from phframe.planners.sure import Sure, SureOptions
from phframe.pushing import WIDE_FAN, Deviation, PushDecision, find_corridor, is_cleared
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.planners.solved import episodes
from tests.planners.sure_plans import (
    AT_WALL,
    HARD,
    ONE,
    SOME,
    assert_told,
    grasps_of,
    kinds,
    planned,
    pushes_of,
    topples_first,
    tree_of,
)
from tests.pushing.parts import scene_of
from tests.pushing.worlds import bench, task_in

# --- On the published scenes ---


def test_all_published_scenes_are_clean_with_at_most_one_push_on_average() -> None:
    found = episodes("sure")
    assert [each.scene.name for each in found if each.status is not Status.RETRIEVED or not each.clean] == []
    assert len(found) == 31
    assert sum(each.pushes for each in found) <= 1.0 * len(found)


def test_few_actions_are_simulated() -> None:
    simulated = sorted(sum(plan.cost.simulated_actions for plan in each.plans) for each in episodes("sure"))
    assert simulated[len(simulated) // 2] <= 3
    assert simulated[-1] <= 20


def test_the_path_is_harmless_and_all_else_says_why_it_was_left() -> None:
    left = 0
    for episode in episodes("sure"):
        assert_told(episode.scene, episode.plans[0])
        left += len(tree_of(episode.plans[0]).nodes) - 1 - len(episode.plans[0].actions)
    assert left


def test_without_noise_a_plan_says_how_much_room_it_leaves_and_no_samples() -> None:
    for episode in episodes("sure"):
        certainty = episode.plans[0].certainty
        assert certainty is not None
        assert certainty.clearance is not None
        assert certainty.clearance >= 0.0
        assert (certainty.samples, certainty.clean, certainty.share) == (0, 0, None)


def test_the_same_inputs_give_the_same_bits() -> None:
    for name in (HARD, "papallas/s01"):
        one, two = (planned(find_scene(name)) for _ in range(2))
        assert one == two
        assert [node.state.poses.tobytes() for node in tree_of(one).nodes] == [
            node.state.poses.tobytes() for node in tree_of(two).nodes
        ]


# --- Its options ---


def test_the_fan_of_the_paper_has_its_corridor_only() -> None:
    angles, pushed = set(), 0
    for scene in SOME:
        plan = planned(scene, {"fan": "paper", "target_pushes": False})
        for node in tree_of(plan).nodes[1:]:
            corridor = PushDecision.of(node.decision).corridor
            assert corridor is not None
            parent = tree_of(plan).nodes[node.parent or ROOT].state
            half_width = corridor.half_width
            paper = find_corridor(parent.positions[scene.target_index], scene.shelf, half_width)
            early = Deviation.ANGLED_EARLY
            assert corridor.angle == getattr(paper, "angle", None) or corridor.beside, early
            angles.add(round(corridor.angle, 6))
            pushed += bool(node.action and node.action.kind is ActionKind.PUSH)
            if node.action and node.action.kind is ActionKind.GRASP:
                assert abs(node.action.path.poses[0, 2] - corridor.angle) <= SureOptions().max_grasp_turn + 1e-9
    assert pushed


def test_a_wide_fan_grasps_at_an_angle_what_is_blocked_straight_ahead() -> None:
    scene = scene_of((0.4, 0.3), (0.1, 0.3))
    wide, paper = (planned(scene, {"fan": fan}) for fan in ("wide", "paper"))
    assert kinds(wide) == [ActionKind.GRASP]
    assert abs(wide.actions[0].path.poses[0, 2]) > 0.2
    assert kinds(paper) == [ActionKind.PUSH, ActionKind.GRASP]


def test_an_empty_corridor_is_emptied_before_the_grasp() -> None:
    beside = scene_of((0.45, 0.3), (0.2, 0.355))
    assert kinds(planned(beside)) == [ActionKind.GRASP]
    for scene in (beside, *SOME):
        plan = planned(scene, {"grasp": "empty-corridor"})
        assert plan.status is Status.RETRIEVED
        tree = tree_of(plan)
        for node in grasps_of(plan):
            before = tree.nodes[node.parent or ROOT].state
            with bench(scene) as made:
                half_width = made.pushing.half_width
            assert is_cleared(scene, before, half_width)


@pytest.mark.parametrize("options", [{"fan": "paper"}, {"fan": "wide"}])
def test_where_the_paper_has_no_corridor_there_is_a_plan_or_a_reason(options: dict[str, Any]) -> None:
    """In a shelf that is narrower than the corridor."""
    narrow = replace(scene_of((0.45, 0.1), (0.2, 0.1)), shelf=replace(ONE.shelf, width=0.2))
    plan = planned(
        narrow, {"half_width": 0.12, "grasp": "empty-corridor", "max_nodes": 20, "target_pushes": False, **options}
    )
    assert plan.succeeded or len(plan.reason) > len("none of 0 simulated actions leads to a clean grasp: ")
    plan = planned(narrow, {"half_width": 0.12, "fan": "paper", "target_pushes": False})
    assert plan.status is Status.FAILED
    assert "0.2 m wide at the target, the corridor 0.24 m" in plan.reason


def test_single_pushes_objects_one_by_one() -> None:
    sizes = {}
    for grouping in ("homology", "single"):
        found = [
            node
            for scene in SOME[:3]
            for node in pushes_of(planned(scene, {"grouping": grouping, "target_pushes": False, "max_nodes": 30}))
        ]
        sizes[grouping] = {len(PushDecision.of(node.decision).chosen) for node in found}
        told = {PushDecision.of(node.decision).diagram is None for node in found}
        assert (grouping == "single") == (told == {True})
    assert sizes["single"] == {1}
    assert max(sizes["homology"]) > 1


def root_pushes(scene: Scene, **options: Any) -> list[PushDecision]:
    """Of obstacles, from the start; nothing that is tried there succeeds, so that all of them are."""
    stays: Apply = lambda state, action, stop: Transition(state, Motion(1.0))  # noqa: E731
    with PlanningWorld(WorldSpec(scene)) as world:
        task = task_in(world)
        still = Task(
            scene=scene,
            start=task.start,
            goal=task.goal,
            arm=task.arm,
            topology=task._topology,
            apply=stays,
            rng=task.rng,
        )
        plan = Sure(SureOptions.parse({"target_pushes": False, **options}, "sure")).plan(still)
    return [PushDecision.of(node.decision) for node in pushes_of(plan)]


def test_the_paper_has_one_direction_for_each_group() -> None:
    def ways(scene: Scene, directions: str) -> dict[tuple[float, tuple[str, ...]], set[int]]:
        found: dict[tuple[float, tuple[str, ...]], set[int]] = {}
        for decision in root_pushes(scene, directions=directions):
            assert decision.corridor is not None
            assert decision.sweep is not None
            key = decision.corridor.angle, decision.chosen
            found.setdefault(key, set()).add(decision.sweep.direction)
        return found

    for scene in SOME[:2]:
        paper, both = ways(scene, "paper"), ways(scene, "both")
        assert paper.keys() == both.keys()
        assert {len(directions) for directions in paper.values()} == {1}
        assert 2 in {len(directions) for directions in both.values()}
        assert all(paper[key] <= both[key] for key in paper)


def test_the_smallest_radius_is_phia_s() -> None:
    several = 0
    for scene in SOME[:2]:
        smallest = root_pushes(scene, radii="smallest")
        with bench(scene) as made:
            first = {}
            for drive in made.drives(*WIDE_FAN):
                if drive.blocking:
                    diagram = made.pushing.diagram(drive.problem)
                    first[drive.angle] = (made.pushing.radii(diagram) or [made.pushing.threshold])[0]
        assert smallest
        for decision in smallest:
            assert decision.corridor is not None
            assert decision.radius == pytest.approx(first[decision.corridor.angle])
        several += len(root_pushes(scene)) > len(smallest)
    assert several


def harmful(scene: Scene, options: dict[str, Any], *, confirms: bool = False) -> Plan:
    """In a world where every push topples something; so it does in the one that executes, if there is another."""
    with PlanningWorld(WorldSpec(scene)) as world:
        topples: Apply = lambda state, action, stop: topples_first(world.apply(state, action, stop), action)  # noqa: E731
        task = task_in(world, confirm=topples if confirms else None)
        task._apply = topples
        return Sure(SureOptions.parse({"max_nodes": 12, **options}, "sure")).plan(task)


@pytest.mark.parametrize("confirms", [False, True])
def test_harm_is_a_dead_end_unless_it_is_allowed(confirms: bool) -> None:
    plan = harmful(ONE, {"target_pushes": False}, confirms=confirms)
    assert plan.status is Status.FAILED
    assert "o0 is toppled" in plan.reason
    assert {node.parent for node in pushes_of(plan)} == {ROOT}
    allowed = harmful(ONE, {"target_pushes": False, "harmful": "allowed"}, confirms=confirms)
    assert allowed.status is Status.RETRIEVED
    assert Condition.TOPPLED in allowed.expected[-1].conditions


@pytest.mark.parametrize("scene", AT_WALL, ids=["south", "north"])
def test_a_target_at_a_wall_is_pushed_away_from_it_and_then_retrieved(scene: Scene) -> None:
    episode = solve(scene, planner="sure")
    assert episode.status is Status.RETRIEVED
    assert episode.clean
    assert [action.moves for action in episode.plans[0].actions[:-1]] == [("target",)] * episode.pushes
    assert episode.pushes >= 1
    assert_told(scene, episode.plans[0])


@pytest.mark.parametrize("scene", AT_WALL, ids=["south", "north"])
def test_without_pushes_of_the_target_it_fails_and_says_what_is_in_the_way(scene: Scene) -> None:
    plan = planned(scene, {"target_pushes": False})
    assert plan.status is Status.FAILED
    assert "wall" in plan.reason
    assert "none of 0" not in plan.reason


def test_no_more_nodes_and_no_more_actions_than_allowed() -> None:
    scene = find_scene(HARD)
    limited = planned(scene, {"max_nodes": 3})
    assert limited.succeeded or limited.reason.endswith("the search was ended by max_nodes=3")
    two = next(each for each in episodes("sure") if each.pushes >= 2)
    short = planned(two.scene, {"max_actions": 1, "max_nodes": 60})
    assert max(tree_of(short).nodes[1:], key=lambda node: len(short.actions)).action is not None
    assert len([kind for kind in kinds(short) if kind is ActionKind.PUSH]) <= 1


# --- What cannot be done ---


class Nothing(Goal[Options]):
    """Nothing that can be reached."""

    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        return Assessment(Status.FAILED, "nothing will do")


def test_another_goal_fails_at_once_and_says_so() -> None:
    plan = planned(ONE, goal=Nothing(Options()))
    assert plan.status is Status.FAILED
    assert "the goal is Nothing" in plan.reason
    assert plan.cost.simulated_actions == 0


def test_a_target_that_lies_fails_at_once_and_says_so() -> None:
    start = ONE.initial_state()
    lying = replace(start, conditions=(Condition.TOPPLED, *start.conditions[1:]))
    plan = planned(ONE, start=lying)
    assert (plan.status, plan.reason) == (Status.FAILED, "the target 'target' is toppled")
    assert plan.cost.simulated_actions == 0
