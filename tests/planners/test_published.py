"""PHIA and OOA on the 31 published scenes: how many they solve, and that they do it by the book."""

from __future__ import annotations

import numpy as np
import pytest

from phframe.bench.meters.outcomes import tally, was_cleared
from phframe.core import ActionKind, Condition, Status
from phframe.pushing import Corridor, PushDecision
from phframe.pushing.corridor import find_corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.persistence import persistent_radii
from tests.planners.solved import PLANNERS, PUBLISHED, episodes, outcomes, pushes
from tests.pushing.parts import in_strip

both = pytest.mark.parametrize("planner", PLANNERS)
THRESHOLD = 1.1 * 0.018 + 2 * 0.03


@pytest.mark.parametrize(("planner", "cleared", "retrieved"), [("phia", 30, 29), ("ooa", 30, 29)])
def test_as_many_are_solved_as_the_specification_asks_for(planner: str, cleared: int, retrieved: int) -> None:
    assert len(PUBLISHED) == len(episodes(planner)) == 31
    figures = tally(planner, "all", outcomes(planner))
    unsolved = [(each.scene, each.episode.reason) for each in outcomes(planner) if not was_cleared(each.episode)]
    assert figures.cleared >= cleared, unsolved
    assert figures.retrieved >= retrieved, unsolved


def test_grouping_takes_fewer_pushes_than_one_object_at_a_time() -> None:
    pairs = [pair for pair in zip(episodes("phia"), episodes("ooa"), strict=True) if all(e.steps for e in pair)]
    assert sum(phia.pushes for phia, _ in pairs) < 0.7 * sum(ooa.pushes for _, ooa in pairs)


@both
def test_what_is_retrieved_is_retrieved_without_a_spill_and_without_touching_a_wall(planner: str) -> None:
    retrieved = [episode for episode in episodes(planner) if episode.status is Status.RETRIEVED]
    assert retrieved
    for episode in retrieved:
        assert (episode.spilled, episode.toppled, episode.wall_contact) == ((), (), False), episode.scene.name
        assert episode.clean
        assert not any(step.motion.stalled for step in episode.steps)


@both
def test_retrieved_is_in_the_hand_and_all_of_it_10_cm_before_the_mouth(planner: str) -> None:
    for episode in episodes(planner):
        if episode.status is Status.RETRIEVED:
            row, last = episode.scene.target_index, episode.final_state
            assert (last.held, last.conditions[row]) == (episode.scene.target, Condition.UPRIGHT)
            assert last.positions[row, 0] + episode.scene.radii[row] <= -0.095


@both
def test_when_it_grasps_the_corridor_is_empty(planner: str) -> None:
    for episode in episodes(planner):
        scene, grasp = episode.scene, episode.steps[-1] if episode.steps else None
        if grasp is None or grasp.action.kind is not ActionKind.GRASP:
            continue
        target, decision = grasp.before.positions[scene.target_index], PushDecision.of(grasp.decision)
        corridor = decision.corridor
        assert corridor is not None
        papers = find_corridor(target, scene.shelf, 0.12)
        assert isinstance(papers, Corridor)
        assert (corridor.beside == papers.beside) is (Deviation.ANGLED_EARLY not in decision.deviations)
        inside = in_strip(corridor, target, grasp.before.positions)
        inside[scene.target_index] = False
        assert not inside.any(), scene.name


@both
def test_the_members_are_those_in_the_corridor_or_in_the_way_of_the_grasp(planner: str) -> None:
    for scene, before, decision, corridor in pushes(planner):
        inside = in_strip(corridor, before.positions[scene.target_index], before.positions) & before.on_board
        inside[scene.target_index] = False
        names = [scene.ids[row] for row in np.flatnonzero(inside)]
        if Deviation.GRASP_BLOCKED in decision.deviations:
            assert names == []
            assert decision.members
        else:
            assert list(decision.members) == names


@both
def test_the_chosen_component_holds_the_nearest_member(planner: str) -> None:
    for scene, before, decision, corridor in pushes(planner):
        rows = [scene.index(name) for name in decision.members]
        ahead = np.array([np.cos(corridor.angle), np.sin(corridor.angle)])
        depth = (before.positions[rows] - corridor.origin) @ ahead
        assert decision.members[int(depth.argmin())] in decision.chosen
        assert decision.labels is not None
        label = decision.labels[decision.members.index(decision.chosen[0])]
        grouped = [name for name, each in zip(decision.members, decision.labels, strict=True) if each == label]
        assert list(decision.chosen) == grouped


def test_phia_takes_the_smallest_usable_radius_or_the_threshold() -> None:
    fallbacks = 0
    for _, _, decision, _ in pushes("phia"):
        assert decision.diagram is not None
        persistent = persistent_radii(decision.diagram.finite_deaths, 0.015)
        assert decision.persistent_radii == tuple(persistent)
        usable = [radius for radius in persistent if radius > THRESHOLD]
        fallback = Deviation.FALLBACK_RADIUS in decision.deviations
        assert fallback is not bool(usable)
        assert decision.radius == pytest.approx(THRESHOLD if fallback else usable[0])
        fallbacks += fallback
    assert fallbacks


def test_phia_groups_by_single_linkage_at_its_radius() -> None:
    grouped = 0
    for scene, before, decision, _ in pushes("phia"):
        points = before.positions[[scene.index(name) for name in decision.members]]
        near = np.linalg.norm(points[:, None] - points[None], axis=2) <= (decision.radius or 0.0) + 1e-4
        reached = np.linalg.matrix_power(near.astype(float), len(points)) > 0
        assert decision.labels is not None
        assert ((decision.labels[:, None] == decision.labels[None]) == reached).all()
        grouped += len(decision.chosen) > 1
    assert grouped


def test_ooa_pushes_one_object_at_a_time() -> None:
    for _, _, decision, _ in pushes("ooa"):
        assert (decision.radius, len(decision.chosen)) == (0.01, 1)
        assert Deviation.FALLBACK_RADIUS not in decision.deviations


@both
def test_planning_simulates_few_actions(planner: str) -> None:
    """What planning costs, counted: time is measured by ``make bench``."""
    simulated = sorted(sum(plan.cost.simulated_actions for plan in episode.plans) for episode in episodes(planner))
    assert simulated[len(simulated) // 2] <= 6
    assert simulated[-1] <= 20


@both
def test_costs_add_up(planner: str) -> None:
    for episode in episodes(planner):
        for plan in episode.plans:
            assert plan.cost.simulated_actions >= len(plan.actions)
            assert 0.0 < plan.cost.simulation + plan.cost.topology <= plan.cost.total
