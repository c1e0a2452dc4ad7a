"""Applying is pure: from any state, in any order, in any process, watched or not."""

from __future__ import annotations

import pickle
from dataclasses import replace
from multiprocessing import active_children

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import (
    Action,
    Budget,
    Condition,
    InputError,
    Plan,
    Rejection,
    State,
    StopCause,
    StopReason,
    Unreachable,
    Watch,
)
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from tests.runtime.worlds import BASIC

SPEC = WorldSpec(BASIC)
ENGINE, GOAL = create(Kind.TOPOLOGY, "ripser"), create(Kind.GOAL, "retrieve")


def plan_in(world: PlanningWorld) -> Plan:
    task = world.task(world.scene.initial_state(), ENGINE, np.random.default_rng(0), goal=GOAL)
    plan: Plan = create(Kind.PLANNER, "ooa").plan(task)
    return plan


WORLD = PlanningWorld(SPEC)
PLAN = plan_in(WORLD)
PAIRS = list(zip([BASIC.initial_state(), *PLAN.expected[:-1]], PLAN.actions, strict=True))
AFTER = [WORLD.apply(*pair) for pair in PAIRS]


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(0, len(PAIRS) - 1), min_size=1, max_size=6))
def test_whatever_ran_before_the_result_is_the_same_bit_by_bit(order: list[int]) -> None:
    for number in order:
        assert WORLD.apply(*PAIRS[number]) == AFTER[number]


def test_a_new_world_comes_to_the_same() -> None:
    with PlanningWorld(pickle.loads(pickle.dumps(SPEC))) as world:
        assert [world.apply(*pair) for pair in PAIRS] == AFTER


def test_nothing_given_is_changed() -> None:
    state, action = PAIRS[0]
    before = pickle.dumps((state, action))
    WORLD.apply(state, action)
    assert pickle.dumps((state, action)) == before


def test_actions_move_something_and_states_go_on_from_one_another() -> None:
    for (state, action), after in zip(PAIRS, AFTER, strict=True):
        moved = after.state.displacement(state)
        assert moved.max() > 1e-3
        assert after.motion.duration > 0.0
        assert set(action.moves) & {BASIC.ids[row] for row in np.flatnonzero(moved > 1e-3)}


@pytest.mark.parametrize("number", [0, 1, len(PAIRS) - 1])
@pytest.mark.parametrize("period", [1 / 30, 0.011])
def test_frames_end_in_the_state_that_the_action_ends_in(number: int, period: float) -> None:
    frames: list[tuple[float, State]] = []
    WORLD.apply(*PAIRS[number], watch=Watch(period, lambda time, state: frames.append((time, state))))
    times = [time for time, _ in frames]
    assert times == sorted(times)
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(AFTER[number].motion.duration)
    assert max(np.diff(times)) <= period + 1 / 240 + 1e-9
    assert frames[-1][1] == AFTER[number].state
    np.testing.assert_allclose(frames[0][1].poses, PAIRS[number][0].poses, atol=1e-9)
    assert len({state.poses.tobytes() for _, state in frames}) > 3


def test_many_at_once_without_workers() -> None:
    assert WORLD.apply_many(PAIRS) == AFTER
    assert WORLD.apply_many([]) == []


@pytest.mark.slow
def test_many_at_once_with_two_workers_come_to_the_same_bits_in_the_same_order() -> None:
    pairs = [PAIRS[number] for number in (3, 0, 2, 0, 1, 3)]
    before = set(active_children())
    with PlanningWorld(SPEC, workers=2) as world:
        assert world.apply_many(pairs) == [AFTER[number] for number in (3, 0, 2, 0, 1, 3)]
        assert len(set(active_children()) - before) == 2
        task = world.task(
            BASIC.initial_state(), ENGINE, np.random.default_rng(0), goal=GOAL, budget=Budget(simulations=6)
        )
        assert task.apply_many(pairs[:2]) == [AFTER[3], AFTER[0]]
        assert task.cost.simulated_actions == 2
    assert set(active_children()) <= before, "the workers end with the world"


def test_an_action_that_the_arm_cannot_do_changes_nothing() -> None:
    class Short(PlanningWorld):
        def plan_trajectory(self, state: State, action: Action) -> Unreachable:
            return Unreachable(0.2, "out of reach")

    with Short(SPEC) as world:
        transition = world.apply(*PAIRS[0])
    assert transition.state == PAIRS[0][0]
    assert (transition.motion.complete, str(transition.motion.stopped)) == (False, "unreachable: out of reach")
    assert transition.motion.stopped == StopReason(StopCause.UNREACHABLE, unreachable=Unreachable(0.2, "out of reach"))


def test_states_of_another_scene_are_refused() -> None:
    other = find_scene("vieira/simple-05").initial_state()
    with pytest.raises(InputError, match="objects"):
        WORLD.apply(other, PAIRS[0][1])


def test_what_has_spilled_stays_spilled_and_is_in_nobodys_way() -> None:
    state, action = PAIRS[0]
    gone = replace(
        state, conditions=tuple(Condition.SPILLED if n != BASIC.target else Condition.UPRIGHT for n in BASIC.ids)
    )
    after = WORLD.apply(gone, action)
    assert after.state.displacement(gone).max() == 0.0
    assert after.motion.contacts == ()


def test_the_task_is_the_worlds() -> None:
    rejected, rng = tuple(Rejection(action, "no") for action in PLAN.actions), np.random.default_rng(3)
    task = WORLD.task(PAIRS[1][0], ENGINE, rng, goal=GOAL, budget=Budget(simulations=1), rejected=rejected)
    assert (task.scene, task.start, task.arm) == (BASIC, PAIRS[1][0], WORLD.arm.shape)
    assert (task.budget, task.rejected) == (Budget(simulations=1), rejected)
    assert task.rejects(PLAN.actions[1]) == rejected[1]
    assert task.goal is GOAL
    assert task.apply(*PAIRS[1]) == AFTER[1]
    assert task.rng.random() == np.random.default_rng(3).random()


def test_specs_are_equal_by_content_and_survive_pickling() -> None:
    options = WorldSpec(BASIC, backend_options={"step": 0.004}, arm_options={"link_width": "0.1"})
    assert pickle.loads(pickle.dumps(options)) == options != SPEC
    assert len(pickle.dumps(SPEC)) < 20_000
    with PlanningWorld(pickle.loads(pickle.dumps(options))) as world:
        assert world.arm.shape.closed[-1].vertices[:, 1].max() == pytest.approx(0.05)


@pytest.mark.slow
@pytest.mark.needs_mujoco
def test_motion_planning_in_workers_counts() -> None:
    pytest.importorskip("mujoco")
    with PlanningWorld(WorldSpec(BASIC, "mujoco"), workers=2) as world:
        world.apply_many(PAIRS[:2])
        assert world.motion_planning_time > 0.0
