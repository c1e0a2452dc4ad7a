"""Sure: few harmless pushes and a clean grasp, each option as it says, and what is confirmed is what then happens."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    Assessment,
    Attempt,
    Budget,
    Condition,
    Episode,
    ExploredTree,
    Goal,
    Motion,
    Options,
    Plan,
    Scene,
    SearchNode,
    State,
    Status,
    Stop,
    StopCause,
    StopReason,
    Task,
    Transition,
    Unreachable,
)
from phframe.core.particle import Apply
from phframe.planners.sure import Sure, SureOptions
from phframe.pushing import WIDE_FAN, Deviation, PushDecision, find_corridor, harm, is_cleared
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.planners.solved import episodes
from tests.pushing.parts import rejections, scene_of
from tests.pushing.worlds import bench, task_in
from tests.runtime.worlds import Meddling, run, shifted

ONE = scene_of((0.45, 0.3), (0.25, 0.3), (0.25, 0.365), (0.25, 0.235), (0.3, 0.17), (0.3, 0.43))
"""What stands before the target leaves no way past it at any angle: one push is needed."""
AT_WALL = tuple(scene_of((0.45, y)) for y in (0.032, 0.568))
"""Alone, 2 mm from a side wall: no finger fits between."""
ELSEWHERE = {"object_friction": 0.35, "arm_friction": 0.45, "standing_radius": 2.0 / 3.0, "arm_acceleration": 10.0}
"""An engine that differs a little from the one that is planned in."""
HARD = "random/1"


class Counted:
    """What applies actions, counting them by state and path.

    Args:
        apply: What does.
    """

    def __init__(self, apply: Apply) -> None:
        self._apply = apply
        self.asked: list[tuple[bytes, bytes]] = []

    def __call__(self, state: State, action: Action, stop: Stop | None = None) -> Transition:
        self.asked.append((state.poses.tobytes(), action.path.poses.tobytes()))
        return self._apply(state, action, stop)


def planned(scene: Scene, options: dict[str, Any] | None = None, start: State | None = None, **more: Any) -> Plan:
    """A plan in pymunk."""
    with PlanningWorld(WorldSpec(scene)) as world:
        return Sure(SureOptions.parse(options or {}, "sure")).plan(task_in(world, start, **more))


def tree_of(plan: Plan) -> ExploredTree:
    assert plan.tree is not None
    return plan.tree


def pushes_of(plan: Plan) -> list[SearchNode]:
    """All that were tried."""
    return [node for node in tree_of(plan).nodes[1:] if node.action and node.action.kind is ActionKind.PUSH]


def grasps_of(plan: Plan) -> list[SearchNode]:
    return [node for node in tree_of(plan).nodes[1:] if node.action and node.action.kind is ActionKind.GRASP]


def kinds(plan: Plan) -> list[ActionKind]:
    return [action.kind for action in plan.actions]


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


def assert_told(scene: Scene, plan: Plan) -> None:
    """Every action of the path does no harm, and every node beside it says why it was left."""
    tree = tree_of(plan)
    before = tree.nodes[ROOT].state
    for node in tree.path:
        assert node.motion is not None
        assert node.action is not None
        moved = None if node.action.kind is ActionKind.GRASP or scene.target in node.action.moves else 0.02
        assert not harm(scene, before, Transition(node.state, node.motion), moved)
        before = node.state
    for row, node in enumerate(tree.nodes):
        assert bool(node.closed) is not (row == ROOT or node in tree.path)


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

SOME = tuple(find_scene(name) for name in ("vieira/basic", "vieira/example-05", "papallas/s02", "papallas/s09"))


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
    assert plan.succeeded or len(plan.reason) > len("none of 0 pushes leads to a grasp: ")
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


def topples_first(made: Transition, action: Action) -> Transition:
    """Every push topples what it means to move."""
    if action.kind is not ActionKind.PUSH:
        return made
    fallen = list(made.state.conditions)
    fallen[1] = Condition.TOPPLED
    return replace(made, state=replace(made.state, conditions=tuple(fallen)))


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


# --- What the arm reaches ---


class Reaching:
    """An arm that can grasp at some angles only.

    Args:
        can: Whether it can, by the gripper's yaw.
    """

    def __init__(self, can: Callable[[float], bool]) -> None:
        self._can = can
        self.asked = 0

    def __call__(self, state: State, action: Action) -> Unreachable | None:
        self.asked += 1
        yaw = float(action.path.poses[0, 2])
        return None if self._can(yaw) else Unreachable(0.1, f"joint 4 at its limit, yaw {np.degrees(yaw):.0f}")


@pytest.mark.parametrize("scene", [scene_of((0.45, 0.3)), ONE, SOME[0]], ids=["alone", "blocked", "basic"])
def test_a_target_beyond_the_arm_is_given_up_after_a_dozen_questions(scene: Scene) -> None:
    reach = Reaching(lambda yaw: False)
    plan = planned(scene, reach=reach)
    assert plan.status is Status.FAILED
    assert "the arm cannot grasp the target at any angle, even in an empty shelf: joint 4 at its limit" in plan.reason
    assert 1 <= reach.asked <= 12


def test_the_same_where_the_arm_that_plans_is_the_one_that_executes() -> None:
    """Then simulating a grasp tells that it is beyond the arm."""

    def apply(state: State, action: Action, stop: Stop | None = None) -> Transition:
        if action.kind is ActionKind.GRASP:
            why = StopReason(StopCause.UNREACHABLE, unreachable=Unreachable(0.1, "joint 4 at its limit"))
            return Transition(state, Motion(0.0, stopped=why))
        return world.apply(state, action, stop)

    reach = Reaching(lambda yaw: False)
    with PlanningWorld(WorldSpec(ONE)) as world:
        task = task_in(world, reach=reach)
        task._apply = apply
        plan = Sure(SureOptions()).plan(task)
    assert plan.status is Status.FAILED
    assert "the arm cannot grasp the target at any angle" in plan.reason
    assert plan.cost.simulated_actions <= 12
    assert reach.asked <= 12


@pytest.mark.parametrize("side", [1, -1])
def test_an_arm_that_reaches_some_angles_grasps_at_one_of_them(side: int) -> None:
    reach = Reaching(lambda yaw: side * yaw > np.radians(20.0))
    for scene in (scene_of((0.4, 0.3)), ONE):
        plan = planned(scene, reach=reach)
        assert plan.status is Status.RETRIEVED
        assert side * plan.actions[-1].path.poses[0, 2] > np.radians(20.0)


# --- What is confirmed ---


def confirmed_in(scene: Scene, confirm: Apply, **options: Any) -> Plan:
    return planned(scene, options, confirm=confirm)


def test_what_does_not_come_true_is_a_dead_end_and_something_else_is_found() -> None:
    first = planned(ONE)
    assert kinds(first) == [ActionKind.PUSH, ActionKind.GRASP]

    def confirm(state: State, action: Action, stop: Stop | None = None) -> Transition:
        made = other.apply(state, action, stop)
        return topples_first(made, action) if action.resembles(first.actions[0]) else made

    with PlanningWorld(WorldSpec(ONE)) as other:
        plan = confirmed_in(ONE, confirm)
    assert plan.status is Status.RETRIEVED
    assert not any(action.resembles(first.actions[0]) for action in plan.actions)
    closed = [node for node in tree_of(plan).nodes if node.closed.startswith("when confirmed: ")]
    assert [node.closed for node in closed] == ["when confirmed: o0 is toppled"]
    assert_told(ONE, plan)


def test_where_nothing_comes_true_it_says_so() -> None:
    def stalls(state: State, _action: Action, _stop: Stop | None = None) -> Transition:
        return Transition(state, Motion(1.0, stalled=True, largest_force=33.0))

    plan = confirmed_in(ONE, stalls, max_nodes=60)
    assert plan.status is Status.FAILED
    assert "when confirmed: the arm stalls at 33 N" in {node.closed for node in tree_of(plan).nodes}


def test_nothing_is_simulated_twice() -> None:
    """From the same state, in the same engine: neither here nor there."""
    for name in (HARD, "vieira/example-05", "papallas/s09", "papallas/s04"):
        scene = find_scene(name)
        with (
            PlanningWorld(WorldSpec(scene)) as world,
            PlanningWorld(WorldSpec(scene, backend_options=ELSEWHERE)) as other,
        ):
            here, there = Counted(world.apply), Counted(_grasps_fail_at_first(other.apply))
            task = task_in(world, confirm=there)
            task._apply = here
            plan = Sure(SureOptions()).plan(task)
        assert plan.status is Status.RETRIEVED
        assert len(set(here.asked)) == len(here.asked)
        assert len(set(there.asked)) == len(there.asked)


def _grasps_fail_at_first(apply: Apply) -> Apply:
    """The first three grasps come to nothing."""
    failed: list[Action] = []

    def confirm(state: State, action: Action, stop: Stop | None) -> Transition:
        if action.kind is ActionKind.GRASP and len(failed) < 3:
            failed.append(action)
            return Transition(state, Motion(1.0, stalled=True, largest_force=31.0))
        return apply(state, action, stop)

    return confirm


def test_the_plan_expects_what_the_engine_that_executes_makes_of_it() -> None:
    scene = SOME[0]
    with PlanningWorld(WorldSpec(scene, backend_options=ELSEWHERE)) as other:
        plan = confirmed_in(scene, other.apply)
        assert plan.status is Status.RETRIEVED
        assert len(plan.actions) >= 2
        state = scene.initial_state()
        for action, expected in zip(plan.actions, plan.expected, strict=True):
            state = other.apply(state, action).state
            np.testing.assert_array_equal(state.poses, expected.poses)


CONFIRMED = ("vieira/basic", "vieira/example-05", "papallas/s02", "papallas/s09")


def elsewhere(name: str, **options: Any) -> Episode:
    """Planned in pymunk as it is, executed in another."""
    return solve(name, planner="sure", options={"plan_backend": ELSEWHERE, "planner": options})


def apart(episode: Episode) -> list[float]:
    """How far the pushes of an episode led from where they were expected to (m)."""
    steps = [step for step in episode.steps if step.action.kind is ActionKind.PUSH and step.expected is not None]
    return [float(step.after.displacement(step.expected).max()) for step in steps if step.expected is not None]


def test_what_was_confirmed_is_what_happens() -> None:
    found = [elsewhere(name) for name in CONFIRMED]
    assert [(each.status, each.clean, len(each.plans)) for each in found] == [(Status.RETRIEVED, True, 1)] * len(found)
    pushed = [distance for episode in found for distance in apart(episode)]
    assert len(pushed) >= 2
    assert max(pushed) <= 1e-6


def test_without_confirmation_reality_differs() -> None:
    assert max(distance for name in CONFIRMED for distance in apart(elsewhere(name, confirm=False))) > 1e-4


# --- Again ---


def test_a_plan_from_where_the_last_one_was_to_be_simulates_less() -> None:
    scene = next(each.scene for each in episodes("sure") if each.pushes >= 2)
    with PlanningWorld(WorldSpec(scene)) as world:
        first = Sure(SureOptions()).plan(task_in(world))
        for done in (0, 1):
            start = first.expected[done - 1] if done else scene.initial_state()
            again, anew = (
                Sure(SureOptions()).plan(task_in(world, start, earlier=earlier))
                for earlier in (tree_of(first).after(done), None)
            )
            assert again.actions == first.actions[done:]
            assert again.cost.simulated_actions < anew.cost.simulated_actions
            assert again.cost.simulated_actions < first.cost.simulated_actions


class Noting(Sure):
    """Notes what it is told of the plan before."""

    def __init__(self) -> None:
        super().__init__(SureOptions())
        self.earlier: list[ExploredTree | None] = []

    def search(self, task: Task) -> Plan:
        self.earlier.append(task.earlier)
        return super().search(task)


def test_in_an_episode_a_replan_knows_what_the_plan_before_had_tried() -> None:
    scene = next(each.scene for each in episodes("sure") if each.pushes >= 2)
    planner, target = Noting(), scene.target
    episode = run(Meddling(WorldSpec(scene), {1: shifted(target, (0.0, 0.012), scene)}), planner)
    assert episode.status is Status.RETRIEVED
    assert len(episode.plans) >= 2
    first, (none, earlier, *_) = episode.plans[0], planner.earlier
    assert none is None
    assert earlier is not None
    assert earlier.nodes[ROOT].state == first.expected[0]
    assert [node.action for node in earlier.path] == list(first.actions[1:])


def test_where_the_world_is_another_what_was_to_come_next_is_tried_first() -> None:
    scene = next(each.scene for each in episodes("sure") if each.pushes >= 2)
    first = planned(scene)
    far = scene.ids.index(max(scene.ids))
    moved = first.expected[0].poses.copy()
    moved[far, 1] += 1e-4
    start = replace(first.expected[0].parked(), poses=moved)
    again = planned(scene, start=start, earlier=tree_of(first).after(1))
    tried = pushes_of(again)[0].action
    assert tried is not None
    assert tried.path == first.actions[1].path


def test_what_was_rejected_is_not_proposed_again() -> None:
    for scene in (ONE, SOME[0]):
        rejected: list[Action] = []
        for _ in range(3):
            plan = planned(scene, {"max_nodes": 40}, rejected=rejections(rejected))
            tried = [node.action for node in tree_of(plan).nodes[1:] if node.action]
            assert not any(each.resembles(action) for each in rejected for action in tried)
            rejected.extend(plan.actions[:1])
        assert len(rejected) == 3


def test_not_even_cut_short() -> None:
    """A push that stalls is cut short anew each time; what was rejected of that is left alone."""

    def cut(plan: Plan) -> list[Action]:
        found = [(node.action, PushDecision.of(node.decision).deviations) for node in tree_of(plan).nodes[1:]]
        return [action for action, deviations in found if action and Deviation.CUT_SHORT in deviations]

    scene = find_scene("papallas/s01")
    options = {"max_nodes": 40, "grasp": "empty-corridor", "target_pushes": False}
    for name in (scene.name, "random/0", "random/5", HARD):
        scene = find_scene(name)
        before = cut(planned(scene, options))
        if before:
            after = cut(planned(scene, options, rejected=rejections(before)))
            assert not any(each.resembles(action) for each in before for action in after)
            return
    pytest.fail("nothing was cut short")


def test_a_budget_of_simulations_decides_alone() -> None:
    scene = find_scene("vieira/basic")
    free = planned(scene)
    assert free.cost.simulated_actions >= 2
    for limit in range(free.cost.simulated_actions + 1):
        slow, quick = (planned(scene, budget=Budget(seconds=seconds, simulations=limit)) for seconds in (1e4, 300.0))
        assert slow == quick
        assert slow.status is (Status.RETRIEVED if limit == free.cost.simulated_actions else Status.TIMEOUT)
        assert slow.cost.simulated_actions == limit
