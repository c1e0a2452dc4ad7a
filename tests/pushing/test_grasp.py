"""The reach passes free of obstacles and walls, and what is drawn out is drawn all the way out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import (
    Action,
    ActionKind,
    Condition,
    Contacts,
    Cylinder,
    FloatArray,
    Infeasible,
    Outline,
    Phase,
    Scene,
    State,
)
from phframe.pushing.corridor import Corridor, find_corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.grasp import FITS, YAW_STEPS, Grasp, GraspFinder, grasp_action
from phframe.pushing.options import PushingOptions
from tests.pushing.parts import ARM, HALF_WIDTH, RADIUS, gap_to_walls, gaps_to_points, often, posed, scene_of
from tests.pushing.sweep_cases import millimetres

ALONG = np.linspace(0.0, 1.0, 15)


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """A target with up to five obstacles, most of them near it."""
    target = draw(millimetres(0.1, 0.56)), draw(millimetres(0.03, 0.57))
    near = st.tuples(millimetres(-0.12, 0.12), millimetres(-0.12, 0.12))
    kept: list[tuple[float, float]] = []
    for dx, dy in draw(st.lists(near, max_size=5)):
        x, y = round(target[0] + dx, 3), round(target[1] + dy, 3)
        apart = all(math.dist((x, y), other) > 0.0601 for other in (target, *kept))
        if apart and 0.0 <= x <= 0.57 and 0.03 <= y <= 0.57:
            kept.append((x, y))
    return scene_of(target, *kept)


def corridor_of(scene: Scene) -> Corridor:
    corridor = find_corridor(np.array(scene.objects[scene.target_index].position), scene.shelf, HALF_WIDTH)
    assert isinstance(corridor, Corridor)
    return corridor


def planned(
    scene: Scene,
    rejected: tuple[Action, ...] = (),
    options: PushingOptions = PushingOptions(),  # noqa: B008 - immutable
) -> Grasp | Infeasible:
    corridor = corridor_of(scene)
    return grasp_action(scene, scene.initial_state(), corridor, ARM, options, lambda each: each in rejected or None)


def every_grasp(scene: Scene, options: PushingOptions) -> tuple[Action, ...]:
    """All that is proposed, one after another being rejected."""
    rejected: tuple[Action, ...] = ()
    while isinstance(found := planned(scene, rejected, options), Grasp):
        rejected = (*rejected, found.action)
    return rejected


def grasp(scene: Scene, state: State | None = None) -> Action | Infeasible:
    found = grasp_action(scene, state or scene.initial_state(), corridor_of(scene), ARM, PushingOptions())
    return found.action if isinstance(found, Grasp) else found


def on_the_way_in(action: Action) -> FloatArray:
    poses = action.path.poses
    return np.asarray(poses[0] + ALONG[:, None] * (poses[1] - poses[0]))


@often
@given(scenes())
def test_the_open_arm_keeps_its_clearance_from_everything_on_the_way_in(scene: Scene) -> None:
    found = grasp(scene)
    if isinstance(found, Infeasible):
        return
    outlines = ARM.outlines(found.path.rules[Phase.REACH].opening)
    centers = scene.initial_state().positions
    for pose in on_the_way_in(found):
        gaps = gaps_to_points(outlines, pose, centers) - scene.radii
        assert gaps[scene.target_index] >= 0.003 - 1e-9, "the fingers pass beside the target"
        assert np.delete(gaps, scene.target_index).min(initial=1.0) >= PushingOptions().neighbour_clearance - 1e-9
        assert gap_to_walls(outlines, pose) >= PushingOptions().neighbour_clearance - 1e-6


@often
@given(scenes())
def test_the_grasp_is_where_the_target_is_and_the_withdrawal_goes_straight_out(scene: Scene) -> None:
    found = grasp(scene)
    if isinstance(found, Infeasible):
        return
    start, tip, closing, end = found.path.poses
    assert found.path.phases == (Phase.REACH, Phase.GRASP, Phase.WITHDRAW)
    assert (found.kind, found.moves) == (ActionKind.GRASP, ("target",))
    assert len({pose[2] for pose in found.path.poses}) == 1
    assert abs(tip[2] - corridor_of(scene).angle) <= math.radians(15.0) + 1e-12
    ahead, target = np.array([math.cos(tip[2]), math.sin(tip[2])]), scene.initial_state().positions[0]
    past = tip[:2] - target
    assert past @ ahead == pytest.approx(float(np.linalg.norm(past)))
    assert any(past @ ahead == pytest.approx(fit) for fit, _ in FITS)
    np.testing.assert_array_equal(tip, closing)
    for other in (start, end):
        assert np.cross([*ahead, 0.0], [*(tip - other)[:2], 0.0])[2] == pytest.approx(0.0, abs=1e-12)
    outlines = ARM.outlines(found.path.rules[Phase.REACH].opening)
    assert max(_corners(outlines, start)) == pytest.approx(-0.05)
    assert max(_corners(ARM.closed, end)) <= -0.05 + 1e-9
    left = target + (end - tip)[:2]
    assert left[0] + RADIUS <= -0.10 + 1e-9, "the whole target is 0.10 m outside"


def _corners(outlines: tuple, pose: FloatArray) -> list[float]:
    ahead = np.array([math.cos(pose[2]), -math.sin(pose[2])])
    return [float(x) for outline in outlines for x in pose[0] + outline.vertices @ ahead]


@often
@given(scenes())
def test_it_is_refused_only_where_at_every_yaw_something_is_in_the_way(scene: Scene) -> None:
    found = grasp(scene)
    if isinstance(found, Action):
        return
    ways = [_touched(scene, yaw, past, clearance) for past, clearance in FITS for yaw in YAW_STEPS[:7]]
    touched = [names for names in ways if names is not None]
    assert all(touched) or found.reason.startswith("grasp blocked by a wall")
    if found.blockers:
        assert set(found.blockers) in touched
        assert len(found.blockers) == min(len(each) for each in touched)
        assert found.reason == f"grasp blocked by {', '.join(found.blockers)}"


def _touched(scene: Scene, deviation: float, past: float, clearance: float) -> set[str] | None:
    """Ids of what a straight reach would touch; None where a wall is in the way."""
    yaw, outlines = corridor_of(scene).angle + deviation, ARM.outlines(2 * (RADIUS + clearance))
    ahead, centers = np.array([math.cos(yaw), math.sin(yaw)]), scene.initial_state().positions
    tip = centers[0] + past * ahead
    length = (tip[0] + 0.05) / ahead[0]
    ways = [np.array([*(tip - fraction * length * ahead), yaw]) for fraction in np.linspace(0.0, 1.0, 7)]
    if min(gap_to_walls(outlines, pose) for pose in ways) < PushingOptions().neighbour_clearance - 1e-6:
        return None
    gaps = gaps_to_points([_drawn_back(outline, length) for outline in outlines], ways[0], centers) - scene.radii
    return {scene.ids[row] for row in np.flatnonzero(gaps < PushingOptions().neighbour_clearance) if row}


def _drawn_back(outline: Outline, length: float) -> Outline:
    """What a part of the planar arm, a rectangle, passes over on a straight way in."""
    (x0, y0), (x1, y1) = outline.vertices.min(axis=0), outline.vertices.max(axis=0)
    return Outline(outline.part, np.array([[x0 - length, y0], [x1, y0], [x1, y1], [x0 - length, y1]]))


def test_the_yaw_deviates_by_up_to_15_degrees_either_way() -> None:
    assert YAW_STEPS[0] == 0.0
    assert sorted(YAW_STEPS) == pytest.approx(sorted(-step for step in YAW_STEPS))
    assert PushingOptions().max_grasp_turn == pytest.approx(math.radians(15.0), abs=1e-4)
    assert max(YAW_STEPS[:7]) == pytest.approx(math.radians(15.0))
    scene = scene_of((0.4, 0.3))
    for turn, tried in ((0.0, 1), (math.radians(15.0), 7), (math.radians(25.0), 11)):
        yaws = {action.path.poses[0, 2] for action in every_grasp(scene, PushingOptions(max_grasp_turn=turn))}
        assert len(yaws) == tried
        assert max(map(abs, yaws)) == pytest.approx(turn, abs=1e-9)


def test_a_neighbour_on_one_side_turns_the_gripper_away() -> None:
    found = grasp(scene_of((0.4, 0.3), (0.42, 0.37)))
    assert isinstance(found, Action)
    assert found.path.poses[0, 2] != 0.0


def test_what_stands_on_both_sides_is_named() -> None:
    found = grasp(scene_of((0.4, 0.3), (0.1, 0.55), (0.4, 0.3605), (0.4, 0.2395)))
    assert found == Infeasible("grasp blocked by o1, o2", ("o1", "o2")) or (
        isinstance(found, Infeasible) and set(found.blockers) <= {"o1", "o2"} and found.blockers
    )


def test_what_has_left_the_board_is_not_in_the_way() -> None:
    scene = scene_of((0.4, 0.3), (0.4, 0.3605), (0.4, 0.2395))
    state = scene.initial_state()
    gone = replace(state, conditions=(Condition.UPRIGHT, Condition.SPILLED, Condition.SPILLED))
    assert isinstance(grasp(scene), Infeasible)
    assert isinstance(grasp(scene, gone), Action)
    toppled = replace(state, conditions=(Condition.UPRIGHT, Condition.TOPPLED, Condition.TOPPLED))
    assert isinstance(grasp(scene, toppled), Infeasible)


def test_a_target_too_wide_for_the_gripper_is_refused_with_both_figures() -> None:
    scene = scene_of((0.4, 0.3))
    wide = replace(scene, objects=(replace(scene.objects[0], shape=Cylinder(0.04)),))
    refused = grasp(wide)
    assert isinstance(refused, Infeasible)
    assert refused.blockers == ()
    assert "0.08 m wide" in refused.reason
    assert "opens 0.08 m" in refused.reason


def test_the_widest_opening_that_the_gripper_has_is_used_for_a_wide_target() -> None:
    scene = scene_of((0.4, 0.3))
    wide = replace(scene, objects=(replace(scene.objects[0], shape=Cylinder(0.036)),))
    found = grasp(wide)
    assert isinstance(found, Action)
    assert found.path.rules[Phase.REACH].opening == pytest.approx(2 * (0.036 + 0.003))


def test_a_wall_in_the_way_is_named() -> None:
    """Behind the mouth's corner: the link does not fit between target and wall at any yaw."""
    corridor = Corridor(np.array([0.0, 0.0]), 0.0, 0.035, 0.01, 0.0, 0.4)
    scene = scene_of((0.4, 0.035))
    refused = grasp_action(scene, scene.initial_state(), corridor, ARM, PushingOptions())
    assert isinstance(refused, Infeasible)
    assert "wall" in refused.reason
    assert refused.blockers == ()


def test_only_the_target_may_be_touched_at_the_set_speed_and_the_fingers_close() -> None:
    scene = scene_of((0.4, 0.3))
    grasp = grasp_action(scene, scene.initial_state(), corridor_of(scene), ARM, PushingOptions(reach_speed=0.125))
    assert isinstance(grasp, Grasp)
    found = grasp.action
    for phase in found.path.phases:
        assert (found.path.rules[phase].speed, found.path.rules[phase].contacts) == (0.125, Contacts.MANIPULAND)
    openings = [found.path.rules[phase].opening for phase in found.path.phases]
    assert openings == pytest.approx([2 * (RADIUS + 0.008), 0.0, 0.0])


@often
@given(scenes())
def test_a_grasp_that_is_turned_or_tight_says_so(scene: Scene) -> None:
    found = planned(scene)
    if isinstance(found, Grasp):
        path = found.action.path
        turned = abs(path.poses[0, 2] - corridor_of(scene).angle) > 1e-9
        tight = path.rules[Phase.REACH].opening < 2 * (RADIUS + 0.008) - 1e-9
        assert (Deviation.GRASP_TURNED in found.deviations, Deviation.GRASP_TIGHT in found.deviations) == (
            turned,
            tight,
        )


def test_rejected_grasps_are_not_proposed_until_none_is_left() -> None:
    scene = scene_of((0.4, 0.3))
    rejected = every_grasp(scene, PushingOptions())
    assert len(set(rejected)) == len(rejected) == len(FITS) * 7
    found = planned(scene, rejected)
    assert isinstance(found, Infeasible)
    assert found.blockers == ()
    assert found.reason == "every grasp that nothing blocks was rejected"


def turned_to(corridor: Corridor, degrees: float) -> Corridor:
    return replace(corridor, angle=math.radians(degrees))


@often
@given(scenes(), st.lists(st.sampled_from([0, 15, -15, 30, -30, 45, -45, 75, -80]), max_size=9), st.booleans())
def test_candidates_at_any_angles_are_as_each_by_itself(scene: Scene, degrees: list[int], straight: bool) -> None:
    corridors = [corridor_of(scene), *[turned_to(corridor_of(scene), each) for each in degrees]]
    state, options = scene.initial_state(), PushingOptions()
    refuse = (lambda each: each.path.poses[0, 2] == 0.0 or None) if straight else (lambda _: None)
    found = GraspFinder(scene, ARM, options).candidates(state, corridors, refuse)
    assert found == [grasp_action(scene, state, corridor, ARM, options, refuse) for corridor in corridors]
    for grasp, corridor in zip(found, corridors, strict=True):
        if isinstance(grasp, Grasp):
            assert grasp.corridor == corridor
            assert abs(grasp.action.path.poses[0, 2] - corridor.angle) <= math.radians(15.0) + 1e-12


def test_no_corridor_no_candidate() -> None:
    scene = scene_of((0.4, 0.3))
    assert GraspFinder(scene, ARM, PushingOptions()).candidates(scene.initial_state(), []) == []


@often
@given(scenes())
def test_the_clearance_is_the_least_distance_on_the_way_in(scene: Scene) -> None:
    found = planned(scene)
    if isinstance(found, Infeasible):
        return
    poses, centers = found.action.path.poses, scene.initial_state().positions
    outlines = ARM.outlines(found.action.path.rules[Phase.REACH].opening)
    length = float(np.linalg.norm(poses[1, :2] - poses[0, :2]))
    swept = [_drawn_back(outline, length) for outline in outlines]
    objects = np.delete(gaps_to_points(swept, poses[1], centers) - scene.radii, scene.target_index)
    walls = min(gap_to_walls(outlines, pose, scene.shelf) for pose in on_the_way_in(found.action))
    assert found.clearance <= min(walls, objects.min(initial=1.0)) + 1e-9
    if objects.min(initial=1.0) < walls:
        assert found.clearance == pytest.approx(objects.min(initial=1.0), abs=1e-9)
    assert found.clearance >= PushingOptions().neighbour_clearance - 1e-6


@often
@given(scenes(), st.sampled_from([0, 5, -10, 15, -30]))
def test_a_withdrawal_between_the_walls_keeps_arm_and_target_between_them(scene: Scene, degrees: int) -> None:
    corridor, state = turned_to(corridor_of(scene), degrees), scene.initial_state()
    found = grasp_action(scene, state, corridor, ARM, PushingOptions())
    if isinstance(found, Infeasible):
        return
    poses, width = found.action.path.poses[2:], scene.shelf.width
    outlines = ARM.outlines(found.action.path.rules[Phase.REACH].opening)
    y = [posed(outline.vertices, *pose)[:, 1] for outline in outlines for pose in poses]
    held = state.positions[0] + np.linspace(0.0, 1.0, 100)[:, None] * (poses[1] - poses[0])[:2]
    arm = min(float(np.min(y)), width - float(np.max(y)))
    target = min(float(held[:, 1].min()), width - float(held[:, 1].max())) - RADIUS
    others = np.linalg.norm(held[:, None] - state.positions[None, 1:], axis=2).min(initial=1.0) - 2.0 * RADIUS
    if found.withdraws_between_walls:
        assert min(arm, target) >= -1e-9
        assert others >= -1e-5
    elif min(arm, target) > 1e-9:
        assert others < 1e-3


@pytest.mark.parametrize(("apart", "withdraws"), [(0.0, True), (-2e-6, False)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_the_arm_passes_over_is_met_by_the_target_that_is_drawn_out_only_where_it_is_more_than_touched(
    apart: float, withdraws: bool, side: float
) -> None:
    scene = scene_of((0.45, 0.3), (0.2, 0.3 + side * (2.0 * RADIUS + apart)))
    flat = replace(scene, objects=(scene.objects[0], replace(scene.objects[1], shape=Cylinder(RADIUS, 0.01))))
    found = planned(flat)
    assert isinstance(found, Grasp)
    assert found.withdraws_between_walls is withdraws
