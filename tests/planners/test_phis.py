"""PHIS: the least pushing time of all that is safe, the same for any number of workers, the best so far at any time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from zlib import crc32

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    ArmState,
    Budget,
    Condition,
    ExploredTree,
    Motion,
    OptionError,
    Options,
    Plan,
    Scene,
    SearchNode,
    State,
    Status,
    Task,
    Transition,
    time_path,
)
from phframe.planners.phis import PHIS, PHISOptions
from phframe.pushing import Deviation, Grasp, PushDecision, Pushing, PushProblem, PushSearch, is_unchanged
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from phframe.topology.single_linkage import SingleLinkage
from tests.planners.solved import PUBLISHED, episodes
from tests.pushing.parts import ARM, RETRIEVE, scene_of

HARD = "random/1"
"""A scene with a tree of several levels."""
UNSAFE = ("stalled", "nothing moved", "something")
"""What begins the reasons that close a node because of what the push did."""


def task_in(world: PlanningWorld, budget: Budget = Budget()) -> Task:  # noqa: B008 - immutable
    rng, topology = np.random.default_rng(0), create(Kind.TOPOLOGY, "ripser")
    return world.task(world.scene.initial_state(), topology, rng, goal=RETRIEVE, budget=budget)


def planned(name: str, budget: Budget = Budget(), workers: int = 1, **options: object) -> Plan:  # noqa: B008
    with PlanningWorld(WorldSpec(find_scene(name)), workers) as world:
        return PHIS(PHISOptions.parse(options, "phis")).plan(task_in(world, budget))


def tree_of(plan: Plan) -> ExploredTree:
    assert plan.tree is not None
    return plan.tree


def pushing_time(nodes: Iterator[SearchNode] | tuple[SearchNode, ...]) -> float:
    return sum(
        node.motion.duration for node in nodes if node.action and node.motion and node.action.kind is ActionKind.PUSH
    )


# --- In a made-up world, against all there is ---

PLACES = st.lists(
    st.sampled_from(list(product((0.1, 0.17, 0.24, 0.31), (0.2, 0.27, 0.34, 0.41)))),
    min_size=2,
    max_size=7,
    unique=True,
)


def any_outcome(seed: int, scene: Scene, state: State, action: Action) -> Transition:
    """Any outcome, decided by the path and from where: some or none are moved out, one spills or topples, the arm stalls."""
    if action.kind is ActionKind.GRASP:
        poses = state.poses - np.eye(1, 7)[0] * 0.6 * (np.arange(len(state.poses)) == scene.target_index)[:, None]
        return Transition(
            replace(state, poses=poses, held="target", arm=ArmState(action.path.poses[-1], 0.06)), Motion(1.0)
        )
    rng = np.random.default_rng([seed, crc32(state.poses.tobytes()), crc32(action.path.poses.tobytes())])
    least = time_path(action.path, 0.0, 1.0).duration
    poses, conditions = state.poses.copy(), list(state.conditions)
    rows = [row for row in range(len(poses)) if row != scene.target_index and rng.random() < 0.5]
    poses[rows, 1] = 0.55
    poses[rows, 0] = 0.05 + 0.04 * np.array(rows)
    if rows and rng.random() < 0.15:
        conditions[rows[0]] = rng.choice([Condition.SPILLED, Condition.TOPPLED])
    motion = Motion(least + float(rng.uniform(0.0, 15.0)), stalled=bool(rng.random() < 0.3))
    return Transition(State(poses, tuple(conditions)), motion)


def made_up(
    scene: Scene,
    seed: int,
    budget: Budget = Budget(),  # noqa: B008 - immutable
    answer: Callable[[State, Action], Transition] | None = None,
) -> Task:
    return Task(
        scene=scene,
        start=scene.initial_state(),
        goal=RETRIEVE,
        arm=ARM,
        topology=SingleLinkage(Options()),
        apply=lambda state, action, stop: (answer or partial(any_outcome, seed, scene))(state, action),
        rng=np.random.default_rng(0),
        budget=budget,
    )


def is_safe(before: State, made: Transition) -> bool:
    return made.motion.complete and before.conditions == made.state.conditions and not is_unchanged(before, made.state)


def least_time(task: Task, search: PushSearch, node: int, options: PHISOptions) -> float:
    """Of all ways to go on from a node, each with the first safe sweep of the closest component at each radius (s)."""
    step = search.next_step(node)
    if not isinstance(step, PushProblem):
        return 0.0 if isinstance(step, Grasp) else np.inf
    pushing, best = Pushing(task, options), np.inf
    diagram = pushing.diagram(step)
    for radius in pushing.radii(diagram) or [pushing.threshold]:
        for decision, action in pushing.pushes(step, diagram, radius):
            made = task.apply(search.state(node), action)
            if is_safe(search.state(node), made):
                child = search.tree.child(node, action, made, decision)
                best = min(best, made.motion.duration + least_time(task, search, child, options))
                break
    return float(best)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.sampled_from(PUBLISHED), st.integers(0, 10_000))
def test_no_way_that_it_searches_takes_less_time(name: str, seed: int) -> None:
    scene, options = find_scene(name), PHISOptions(patience=1000, max_nodes=1_000_000)
    plan, task = PHIS(options).plan(made_up(scene, seed)), made_up(scene, seed)
    least = least_time(task, PushSearch(task, options), ROOT, options)
    if np.isfinite(least):
        assert plan.status is Status.RETRIEVED
        assert pushing_time(tree_of(plan).path) == pytest.approx(least)


@settings(max_examples=60, deadline=None)
@given(PLACES, st.integers(0, 1000), st.sampled_from(["paper", "both"]))
def test_its_path_is_safe_and_the_quickest_in_its_tree(
    places: list[tuple[float, float]], seed: int, directions: str
) -> None:
    options = PHISOptions.parse({"directions": directions}, "phis")
    plan = PHIS(options).plan(made_up(scene_of((0.45, 0.3), *places), seed))
    tree = tree_of(plan)
    before = tree.nodes[ROOT].state
    for node in tree.path:
        assert node.motion is not None
        assert is_safe(before, Transition(node.state, node.motion)) or node.state.held
        assert not node.closed or plan.status is Status.FAILED
        before = node.state
    ends = [row for row, node in enumerate(tree.nodes) if node.state.held]
    times = [pushing_time(ExploredTree(tree.nodes, row).path) for row in ends]
    assert (plan.status is Status.RETRIEVED) is bool(ends)
    assert not ends or pushing_time(tree.path) == min(times)


@settings(max_examples=25, deadline=None)
@given(PLACES, st.integers(0, 1000))
def test_when_the_budget_runs_out_the_best_plan_so_far_counts(places: list[tuple[float, float]], seed: int) -> None:
    scene, planner = scene_of((0.45, 0.3), *places), PHIS(PHISOptions(directions="both"))
    free = planner.plan(made_up(scene, seed))
    limits = range(free.cost.simulated_actions)
    plans = [*(planner.plan(made_up(scene, seed, Budget(simulations=limit))) for limit in limits), free]
    found = [plan for plan in plans if plan.status is Status.RETRIEVED]
    assert found == plans[len(plans) - len(found) :], "what was found is not lost again"
    times = [pushing_time(tree_of(plan).path) for plan in found]
    assert times == sorted(times, reverse=True)


@settings(max_examples=60, deadline=None)
@given(PLACES, st.integers(0, 1000), st.integers(1, 12))
def test_no_further_push_is_tried_once_the_tree_is_as_large_as_allowed(
    places: list[tuple[float, float]], seed: int, most: int
) -> None:
    scene = scene_of((0.45, 0.3), *places)
    free, plan = (PHIS(PHISOptions(max_nodes=limit)).plan(made_up(scene, seed)) for limit in (1_000_000, most))
    pushes = [node for node in tree_of(plan).nodes if node.action and node.action.kind is ActionKind.PUSH]
    assert len(pushes) < most
    was_cut = len(tree_of(free).nodes) > len(tree_of(plan).nodes)
    if plan.status is Status.FAILED and was_cut:
        assert plan.reason.endswith(f"the search was ended by max_nodes={most}")
    elif not was_cut:
        assert plan.actions == free.actions


def test_where_nothing_is_safe_every_sweep_of_every_radius_is_tried_once() -> None:
    several = 0
    for name in PUBLISHED:
        scene = find_scene(name)
        task = made_up(scene, 0, answer=lambda state, action: Transition(state, Motion(1.0, stalled=True)))
        plan = PHIS(PHISOptions()).plan(task)
        paths = [node.action.path.poses.tobytes() for node in tree_of(plan).nodes if node.action]
        pushing = Pushing(task, PHISOptions())
        problem = pushing.problem(task.start)
        assert isinstance(problem, PushProblem)
        if len(problem.members):
            radii = [list(sweeps) for sweeps in pushing.pushes_at_all_radii(problem)]
            assert len(set(paths)) == len(paths)
            assert set(paths) == {action.path.poses.tobytes() for sweeps in radii for _, action in sweeps}
            several += len({sweeps[0][1].path.poses.tobytes() for sweeps in radii}) < len(radii)
    assert several, "radii whose first sweep is the same"


# --- In the real one ---


def test_all_published_scenes_are_retrieved_in_fewer_pushes_than_by_phia() -> None:
    found = episodes("phis")
    assert [each.scene.name for each in found if each.status is not Status.RETRIEVED or not each.clean] == []
    assert len(found) == len(PUBLISHED)
    assert sum(each.pushes for each in found) < 0.8 * sum(each.pushes for each in episodes("phia"))


def test_planning_simulates_few_actions() -> None:
    """What planning costs, counted: time is measured by the bench."""
    simulated = sorted(sum(plan.cost.simulated_actions for plan in each.plans) for each in episodes("phis"))
    assert simulated[len(simulated) // 2] <= 6
    assert simulated[-1] <= 25


def test_its_tree_says_what_each_node_is_worth_and_why_it_was_left() -> None:
    unsafe = 0
    for episode in episodes("phis"):
        tree = tree_of(episode.plans[0])
        for row, node in enumerate(tree.nodes):
            assert node.value == pytest.approx(pushing_time(ExploredTree(tree.nodes, row).path))
            on_path = node in tree.path or row == ROOT
            assert bool(node.closed) is not on_path
            unsafe += node.closed.startswith(UNSAFE)
    assert unsafe


def test_every_usable_radius_is_tried_at_the_root_and_what_is_alike_only_once() -> None:
    several = 0
    for episode in episodes("phis"):
        tree = tree_of(episode.plans[0])
        first = [node for node in tree.nodes if node.parent == ROOT and node.action and node.action.moves]
        paths = [node.action.path.poses.tobytes() for node in first if node.action]
        assert len(set(paths)) == len(paths)
        radii = {PushDecision.of(node.decision).radius for node in first}
        several += len(radii) > 1
        fallback = [Deviation.FALLBACK_RADIUS in PushDecision.of(node.decision).deviations for node in first]
        usable = [[r for r in PushDecision.of(node.decision).persistent_radii if r > 0.0798] for node in first]
        assert fallback == [not radii for radii in usable]
    assert several >= 10


def test_the_next_sweep_of_a_group_is_tried_where_the_one_before_was_not_safe() -> None:
    retried = 0
    for episode in episodes("phis"):
        nodes = [node for node in tree_of(episode.plans[0]).nodes if node.action and node.action.moves]
        for node, group in {(node.parent, node.action.moves) for node in nodes if node.action}:
            tried = [each for each in nodes if each.action and (each.parent, each.action.moves) == (node, group)]
            assert all(each.closed.startswith(UNSAFE) for each in tried[:-1])
            counted = [Deviation.NEXT_SWEEP in PushDecision.of(each.decision).deviations for each in tried]
            assert counted == [False] + [True] * (len(tried) - 1)
            retried += len(tried) > 1
    assert retried


def test_both_directions_if_asked_for() -> None:
    def ways(plan: Plan) -> list[tuple[float | None, int]]:
        first = [PushDecision.of(node.decision) for node in tree_of(plan).nodes if node.parent == ROOT]
        return [(each.radius, each.sweep.direction) for each in first if each.sweep is not None]

    paper, both = (set(ways(planned("random/0", directions=way))) for way in ("paper", "both"))
    assert paper < both
    assert {direction for _, direction in both} == {1, -1}
    assert {radius for radius, _ in both} == {radius for radius, _ in paper}


def test_the_paper_s_one_direction_and_both_exclude_each_other() -> None:
    with pytest.raises(OptionError, match="one direction"):
        PHISOptions.parse({"directions": "both", "sweeps": "paper"}, "planner phis")


@pytest.mark.slow
def test_with_a_budget_in_simulations_any_number_of_workers_gives_the_same_plan() -> None:
    scene, cut = find_scene(HARD), 0
    with PlanningWorld(WorldSpec(scene)) as one, PlanningWorld(WorldSpec(scene), workers=2) as two:
        planner = PHIS(PHISOptions(directions="both"))
        free = planner.plan(task_in(one))
        assert planner.plan(task_in(two)) == free
        for limit in range(free.cost.simulated_actions + 1):
            plans = [planner.plan(task_in(world, Budget(simulations=limit))) for world in (one, two)]
            assert plans[0] == plans[1]
            assert [plan.cost.simulated_actions for plan in plans] == [limit, limit]
            cut += plans[0] != free
    assert free.cost.simulated_actions >= 10
    assert cut >= 10


def test_no_more_pushes_than_allowed() -> None:
    pushes = len(planned(HARD).actions) - 1
    plan = planned(HARD, max_actions=pushes - 1)
    assert pushes >= 2
    assert f"the corridor is not empty after {pushes - 1} actions" in {node.closed for node in tree_of(plan).nodes}
    assert len([action for action in plan.actions if action.kind is ActionKind.PUSH]) <= pushes - 1
