"""Pushes that stall are cut short where they did, whatever the arm approached from, and what is left of them does not."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from phframe.core import ActionKind, ArmState, Motion, State, Transition
from phframe.planners.sure import SureOptions
from phframe.pushing import WIDE_FAN, Deviation, Proposal, PushDecision, Sweep, corridor_at, cut_short, push_action
from phframe.pushing.cut_short import SHORT_OF_STALL
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import ARM, SHELF, often, scene_of
from tests.pushing.worlds import bench, task_in

OPTIONS = SureOptions()
JAM = scene_of((0.5, 0.3), *((0.3, round(0.33 + 0.0601 * number, 4)) for number in range(4)))
"""A row of obstacles from the middle to 3 cm from the north wall, so that a push to the north soon jams them."""
STATE = scene_of((0.5, 0.3)).initial_state()


def sweep_of(decision: PushDecision) -> Sweep:
    assert decision.sweep is not None
    return decision.sweep


@st.composite
def pushes(draw: st.DrawFn) -> Proposal:
    """Sweeps in any corridor, in either direction, tilted or not."""
    corridor = corridor_at(draw(st.floats(-0.7, 0.7)), np.array([0.5, 0.3]), 0.08)
    direction: Literal[1, -1] = 1 if draw(st.booleans()) else -1
    lane = draw(st.floats(-0.2, 0.2))
    end = lane + direction * draw(st.floats(0.021, 0.3))
    entry, out, tilt = draw(st.floats(0.1, 0.6)), draw(st.floats(0.1, 0.6)), draw(st.floats(-0.5, 0.5))
    sweep = Sweep(direction, draw(st.floats(0.05, 0.5)), lane, end, entry, out, tilt)
    action = push_action(corridor, sweep, ("o0",), ARM.min_opening, OPTIONS)
    return PushDecision("made up", corridor=corridor, chosen=("o0",), sweep=sweep), action


def stalled_at(push: Proposal, fraction: float, back: float) -> Transition:
    """What becomes of a push that stalls so far across (m), and of which the arm then draws straight back (m)."""
    poses = push[1].path.poses
    pose = poses[1] + fraction * (poses[2] - poses[1])
    pose[:2] -= back * np.array([math.cos(pose[2]), math.sin(pose[2])])
    return Transition(State(STATE.poses, STATE.conditions, arm=ArmState(pose, 0.0)), Motion(1.0, stalled=True))


@often
@given(pushes(), st.floats(0.0, 1.0), st.floats(0.0, 0.8))
def test_it_ends_a_centimetre_before_it_stalled_however_far_the_arm_drew_back(
    push: Proposal, fraction: float, back: float
) -> None:
    sweep = sweep_of(push[0])
    across = fraction * abs(sweep.end - sweep.lane)
    assume(abs(across - 2.0 * SHORT_OF_STALL) > 1e-6)
    shorter = cut_short(push, stalled_at(push, fraction, back), OPTIONS)
    assert (shorter is None) is (across < 2.0 * SHORT_OF_STALL)
    if shorter is not None:
        assert sweep_of(shorter[0]).end == pytest.approx(sweep.lane + sweep.direction * (across - SHORT_OF_STALL))


@often
@given(pushes(), st.floats(0.0, 1.0))
def test_the_way_in_is_as_it_was_and_the_way_out_begins_where_the_sweep_ends(push: Proposal, fraction: float) -> None:
    found = cut_short(push, stalled_at(push, fraction, 0.3), OPTIONS)
    assume(found is not None)
    assert found is not None
    (decision, action), (before, whole) = found, push
    old, new = whole.path.poses, action.path.poses
    np.testing.assert_allclose(new[:2], old[:2], atol=1e-12)
    assert (action.kind, action.moves, action.path.phases) == (ActionKind.PUSH, whole.moves, whole.path.phases)
    assert np.ptp(new[:, 2]) == 0.0
    share = (sweep_of(decision).end - sweep_of(before).lane) / (sweep_of(before).end - sweep_of(before).lane)
    assert 0.0 < share < 1.0
    np.testing.assert_allclose(new[2], old[1] + share * (old[2] - old[1]), atol=1e-9)
    ways_out = [np.linalg.norm(old[leg, :2] - old[end, :2]) for leg, end in ((1, 0), (2, 3))]
    out = new[3, :2] - new[2, :2]
    assert np.linalg.norm(out) == pytest.approx(ways_out[0] + share * (ways_out[1] - ways_out[0]))
    np.testing.assert_allclose(out / np.linalg.norm(out), [-math.cos(new[2, 2]), -math.sin(new[2, 2])], atol=1e-9)
    assert Deviation.CUT_SHORT in decision.deviations


def test_one_that_is_cut_twice_says_so_once() -> None:
    corridor = corridor_at(0.0, np.array([0.5, 0.3]), 0.08)
    sweep = Sweep(1, 0.3, 0.0, 0.2, 0.4, 0.4)
    push = PushDecision("", corridor=corridor, sweep=sweep), push_action(corridor, sweep, ("o0",), 0.0, OPTIONS)
    once = cut_short(push, stalled_at(push, 0.8, 0.2), OPTIONS)
    assert once is not None
    twice = cut_short(once, stalled_at(once, 1.0, 0.2), OPTIONS)
    assert twice is not None
    assert sweep_of(twice[0]).end == pytest.approx(0.14)
    assert twice[0].deviations == (Deviation.CUT_SHORT,)


def test_an_arm_that_nobody_sees_afterwards_or_no_sweep_is_not_cut() -> None:
    corridor = corridor_at(0.0, np.array([0.5, 0.3]), 0.08)
    sweep = Sweep(1, 0.3, 0.0, 0.2, 0.4, 0.4)
    push = PushDecision("", corridor=corridor, sweep=sweep), push_action(corridor, sweep, ("o0",), 0.0, OPTIONS)
    made = stalled_at(push, 0.8, 0.2)
    assert cut_short(push, replace(made, state=made.state.parked()), OPTIONS) is None
    assert cut_short((replace(push[0], sweep=None), push[1]), made, OPTIONS) is None


def test_a_jam_is_not_pressed_again() -> None:
    with bench(JAM) as made:
        northwards = [push for push in made.pushes(0.0) if sweep_of(push[0]).direction == 1]
        jams = [
            (push, each) for push in northwards if (each := made.task.apply(made.task.start, push[1])).motion.stalled
        ]
        assert jams, "the row does not reach the wall"
        for push, stalled in jams:
            shorter = cut_short(push, stalled, OPTIONS)
            assert shorter is not None
            again = made.task.apply(made.task.start, shorter[1])
            assert again.motion.complete
            assert again.state.displacement(made.task.start).max() > 0.005


def test_no_stalled_sweep_of_published_scenes_stalls_again_when_it_is_cut_short() -> None:
    cut = 0
    for name in ("vieira/basic", "vieira/example-05", "papallas/s02"):
        with bench(find_scene(name)) as made:
            for push in made.pushes(*WIDE_FAN[:3]):
                stalled = made.task.apply(made.task.start, push[1])
                shorter = cut_short(push, stalled, OPTIONS) if stalled.motion.stalled else None
                if shorter is not None:
                    assert not made.task.apply(made.task.start, shorter[1]).motion.stalled
                    cut += 1
    assert cut >= 3


def test_where_the_arm_approaches_from_makes_no_difference() -> None:
    """What was driven before the path begins is no part of the sweep."""
    with PlanningWorld(WorldSpec(JAM)) as world, bench(JAM) as made:
        push = next(push for push in made.pushes(0.0) if sweep_of(push[0]).direction == 1)
        near = JAM.initial_state()
        away = replace(near, arm=ArmState(np.array([-0.5, SHELF.width / 2.0, 0.0]), ARM.min_opening))
        ends = []
        for start in (near, away):
            stalled = task_in(world, start).apply(start, push[1])
            shorter = cut_short(push, stalled, OPTIONS)
            assert shorter is not None
            ends.append(sweep_of(shorter[0]).end)
        assert ends[0] == pytest.approx(ends[1], abs=1e-3)
