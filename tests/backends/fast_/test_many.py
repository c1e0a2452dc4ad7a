"""Many motions in one call, and the same bits whoever runs them."""

from __future__ import annotations

import pickle
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import phframe
from phframe.core import InputError, Phase, Stop, SupportsManySimulations
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from phframe.testing.physics.paths import CROWD_SWEEP, crowd, drive_in, grasp, path, sweep
from phframe.testing.physics.stand import on_stand
from tests.backends.fast_.stand import ARM, fast, subject, swept

pytestmark = pytest.mark.needs_fast

IN_A_NEW_PROCESS = """
import pickle, sys
from tests.backends.fast_.stand import swept
sys.stdout.buffer.write(pickle.dumps(swept()))
"""
WAYS = (CROWD_SWEEP, drive_in(0.4), sweep(0.3, 0.5, 0.1), drive_in(0.7, 0.2), grasp(ARM, 0.5), drive_in(0.1))


@pytest.mark.parametrize("stop", [None, Stop(force=2.0), Stop(bodies=frozenset({"a", "b"}), wall=True)])
def test_many_are_as_one_by_one(stop: Stop | None) -> None:
    with on_stand(subject(), crowd()) as stand:
        pushed = stand.run(stand.start, CROWD_SWEEP).state.parked()
        inside = stand.run(stand.start, drive_in(0.25, 0.2), settle=None).state
        pairs = [(state, stand.trajectory(state, way)) for state in (stand.start, pushed) for way in WAYS]
        back = path([[0.25, 0.2, 0.0], [0.25, 0.35, 0.0]], [Phase.SWEEP])
        pairs.append((inside, stand.trajectory(inside, back)))
        alone = [stand.physics.simulate(state, trajectory, stop=stop) for state, trajectory in pairs]
        physics = stand.physics
        assert isinstance(physics, SupportsManySimulations)
        together = physics.simulate_many(*zip(*pairs, strict=True), stop=stop)
        assert together == alone
        assert len({transition.state for transition in together}) > 5


def test_none_are_none() -> None:
    assert fast(crowd()).simulate_many([], []) == []


def test_one_that_begins_elsewhere_is_refused() -> None:
    with on_stand(subject(), crowd()) as stand:
        inside = stand.run(stand.start, drive_in(0.2)).state
        far = stand.trajectory(stand.start, drive_in(0.3))
        with pytest.raises(InputError, match="begins"):
            stand.physics.simulate_many([inside], [far])  # type: ignore[attr-defined]


def test_planners_get_many_at_once() -> None:
    """A sweep that stalls and draws back, too, is as ``apply`` has it."""
    episode = phframe.solve("vieira/simple-07", backend="fast")
    actions = [step.action for step in episode.steps]
    with PlanningWorld(WorldSpec(episode.scene, "fast")) as world:
        start = episode.scene.initial_state()
        pairs = [(start, action) for action in actions]
        assert len(pairs) > 1
        assert world.apply_many(pairs) == [world.apply(*pair) for pair in pairs]


@settings(max_examples=20, deadline=None)
@given(depth=st.floats(0.1, 0.5), begin=st.floats(0.08, 0.5), end=st.floats(0.08, 0.5), other=st.floats(0.1, 0.5))
def test_it_is_pure(depth: float, begin: float, end: float, other: float) -> None:
    with on_stand(subject(), crowd()) as stand:
        first = stand.run(stand.start, sweep(depth, begin, end))
        stand.run(first.state, sweep(other, begin, end))
        assert stand.run(stand.start, sweep(depth, begin, end)) == first


def test_another_process_gives_the_same_bits() -> None:
    done = subprocess.run([sys.executable, "-c", IN_A_NEW_PROCESS], capture_output=True, check=True, timeout=300)
    assert pickle.loads(done.stdout) == swept()
