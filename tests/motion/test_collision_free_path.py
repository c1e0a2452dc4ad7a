"""Collision-free joint paths, searched by OMPL."""

from __future__ import annotations

import gc
import math
import os
import pickle
import signal
import subprocess
import sys
import weakref
from itertools import pairwise
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import phframe
from phframe.core import ArmError, FloatArray, NotInstalledError, UnknownNameError
from phframe.motion.budget import SearchBudget
from phframe.motion.collision_free_path import DEFAULT, PLANNERS, collision_free_path
from phframe.motion.edges import Edges, bisection
from phframe.motion.path_shortcutting import shortened
from tests.motion.mazes import Valid, length, limits, looked_at, walls

needs_ompl = pytest.mark.needs_ompl
RESOLUTION = 0.05
GAPS = ((0.6, 1.4), (-1.4, -0.6))
"""Of two walls, so far apart that no straight line leads through both."""
ONE = (0.5, 1.5)
"""The gap of one wall, wide enough for the slowest planners, and off the straight line."""


def solve(planner: str = DEFAULT, *, seed: int = 0, dof: int = 3, **changes: Any) -> FloatArray | None:
    """From before the walls to behind them."""
    pytest.importorskip("ompl", reason="needs the extra 'ompl'")
    gaps = changes.pop("gaps", (ONE,))
    lower, upper = limits(dof, len(gaps))
    start, goal = np.zeros(dof), np.zeros(dof)
    start[0], goal[0] = 0.4, len(gaps) + 0.6
    given: dict[str, Any] = {
        "start": start, "goals": goal[None], "lower": lower, "upper": upper, "valid": walls(*gaps), "planner": planner,
        "resolution": RESOLUTION, "rng": np.random.default_rng(seed),
        "stop": SearchBudget(2 * changes.pop("iterations", 500 if "star" in planner else 3000), math.inf).search(),
    }  # fmt: skip
    return collision_free_path(**{**given, **changes})


def check(path: FloatArray | None, valid: Valid, *, start: FloatArray, goals: FloatArray, dof: int = 3) -> None:
    assert path is not None
    assert path.shape[1] == dof
    assert (path[0] == start).all()
    assert any((path[-1] == goal).all() for goal in goals)
    for a, b in pairwise(path):
        assert all(valid(q) for q in looked_at(a, b, RESOLUTION))


@needs_ompl
@pytest.mark.parametrize("planner", PLANNERS)
def test_every_planner_finds_the_way_through_the_gap(planner: str) -> None:
    path = solve(planner)
    check(path, walls(ONE), start=np.array([0.4, 0.0, 0.0]), goals=np.array([[1.6, 0.0, 0.0]]))


@needs_ompl
@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32), planner=st.sampled_from(("RRTConnect", "BKPIECE1", "LBKPIECE1", "BiEST")))
def test_paths_through_two_gaps_are_valid_and_short(seed: int, planner: str) -> None:
    path = solve(planner, seed=seed, gaps=GAPS, iterations=100_000)
    check(path, walls(*GAPS), start=np.array([0.4, 0.0, 0.0]), goals=np.array([[2.6, 0.0, 0.0]]))
    assert path is not None
    assert length(path) < 5.0 * length(np.array([[0.4, 0.0, 0.0], [1.0, 0.6, 0.0], [2.0, -0.6, 0.0], [2.6, 0.0, 0.0]]))


PROGRAM = """
import pickle, sys
import tests.motion.test_collision_free_path as module
paths = [module.solve(planner, seed=7) for planner in module.PLANNERS]
pickle.dump([path.tobytes() for path in paths], sys.stdout.buffer)
"""


@needs_ompl
def test_the_same_inputs_give_the_same_bits_whatever_ran_before() -> None:
    pytest.importorskip("ompl")
    root = Path(phframe.__file__).parents[1]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    command = [sys.executable, "-W", "error", "-c", PROGRAM]
    other = subprocess.run(command, capture_output=True, check=True, env=environment, cwd=root)
    assert other.stderr == b""
    elsewhere = pickle.loads(other.stdout)

    from ompl import util

    for path, planner in zip(elsewhere, PLANNERS, strict=True):
        solve(planner, seed=1)
        util.RNG().uniform01()
        found = solve(planner, seed=7)
        assert found is not None
        assert found.tobytes() == path, planner


@needs_ompl
@pytest.mark.parametrize("planner", ["RRTConnect", "BiEST", "LBKPIECE1"])
def test_another_seed_gives_another_path(planner: str) -> None:
    paths = [solve(planner, seed=seed) for seed in range(3)]
    assert len({path.tobytes() for path in paths if path is not None}) == 3


@needs_ompl
@pytest.mark.parametrize("planner", PLANNERS)
def test_a_wall_without_a_gap_ends_after_the_iterations(planner: str) -> None:
    asked = []

    def closed(q: FloatArray) -> bool:
        asked.append(q)
        return abs(float(q[0]) - 1.0) > 0.1

    assert solve(planner, valid=closed, iterations=50) is None
    few = len(asked)
    assert solve(planner, valid=closed, iterations=400) is None
    assert few < len(asked) - few or planner in ("FMT", "BFMT"), "those two draw all they need beforehand"


@needs_ompl
@pytest.mark.parametrize("planner", PLANNERS)
def test_time_ends_it_too_and_the_budget_says_so(planner: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a clock that goes on by a second whenever someone looks at it."""
    ticks = iter(range(10**9))
    monkeypatch.setattr("phframe.motion.budget.time.monotonic", lambda: float(next(ticks)))
    budget = SearchBudget(10**9, 100.0)
    assert solve(planner, valid=walls((5.0, 6.0)), stop=budget.search()) is None
    assert budget.timed_out
    assert 100 <= next(ticks) < 200


@needs_ompl
def test_a_straight_line_is_not_searched_for() -> None:
    rng = np.random.default_rng(0)
    goals = np.array([[3.0, 0.0, 0.0], [1.9, 0.5, 0.0], [0.5, 1.5, 0.0]])
    path = solve(goals=goals, valid=lambda q: not 0.8 < q[1] < 1.0, rng=rng)
    np.testing.assert_array_equal(path, [[0.4, 0.0, 0.0], [1.9, 0.5, 0.0]])
    assert rng.bit_generator.state == np.random.default_rng(0).bit_generator.state, "nothing was drawn"


@needs_ompl
def test_any_of_several_goals_will_do_but_not_one_that_is_not_valid() -> None:
    start = np.array([0.4, 0.0, 0.0])
    goals = np.array([[1.05, 0.0, 0.0], [1.6, 0.0, 9.0], [1.6, -1.0, 0.5], [1.7, 1.0, 0.0]])
    path = solve(goals=goals)
    check(path, walls(ONE), start=start, goals=goals[2:])
    assert solve(goals=goals[:2]) is None
    assert solve(goals=goals[:0]) is None
    assert solve(start=np.array([1.0, 0.0, 0.0])) is None
    assert solve(start=np.array([-0.1, 0.0, 0.0])) is None, "beyond the limits"


class OddError(Exception):
    pass


@needs_ompl
@pytest.mark.parametrize("planner", PLANNERS)
def test_what_the_check_raises_comes_out_as_it_is(planner: str) -> None:
    raised, count = OddError("odd"), iter(range(10**9))

    def failing(q: FloatArray) -> bool:
        if next(count) > 200:
            raise raised
        return abs(float(q[0]) - 1.0) > 0.1

    with pytest.raises(OddError) as caught:
        solve(planner, valid=failing)
    assert caught.value is raised
    raised.__traceback__ = None  # it holds what holds it, through OMPL, where no garbage collector can see
    assert solve(planner) is not None, "and all is well afterwards"


@needs_ompl
@pytest.mark.parametrize("planner", ["RRTConnect", "BKPIECE1", "BiEST"])
def test_ctrl_c_stops_it(planner: str) -> None:
    pytest.importorskip("ompl")

    def interrupt(_: int, __: FrameType | None) -> None:
        signal.raise_signal(signal.SIGINT)

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(KeyboardInterrupt):
            solve(planner, valid=lambda q: abs(float(q[0]) - 1.0) > 0.1, iterations=10**9)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


@needs_ompl
@pytest.mark.parametrize("planner", PLANNERS)
def test_nothing_is_said_and_the_log_level_is_left_alone(planner: str, capfd: pytest.CaptureFixture[str]) -> None:
    util = pytest.importorskip("ompl.util")
    level = util.getLogLevel()
    try:
        util.setLogLevel(util.LOG_DEV2)
        solve(planner)
        solve(planner, valid=walls((5.0, 6.0)), iterations=20)
        assert util.getLogLevel() == util.LOG_DEV2
    finally:
        util.setLogLevel(level)
    assert capfd.readouterr() == ("", "")


@needs_ompl
@pytest.mark.parametrize("planner", PLANNERS)
def test_nothing_of_a_call_stays_behind(planner: str) -> None:
    def valid(q: FloatArray) -> bool:
        return walls(ONE)(q)

    remembered = weakref.ref(valid)
    solve(planner, valid=valid)
    del valid
    gc.collect()
    assert remembered() is None


def test_an_unknown_planner_is_answered_with_those_there_are() -> None:
    with pytest.raises(
        UnknownNameError, match=r"no path planner named 'RTConnect'. Did you mean 'RRTConnect'\?.*BiEST"
    ):
        ask(planner="RTConnect")
    with pytest.raises(UnknownNameError, match="There is: AORRTC"):
        ask(planner="PRM")


def test_without_ompl_the_error_names_the_install_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ompl", None)
    monkeypatch.delitem(sys.modules, "ompl.base", raising=False)
    with pytest.raises(NotInstalledError, match=r"'RRTConnect' needs ompl, which is not installed.*phframe\[ompl\]"):
        ask()


@needs_ompl
@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"start": np.zeros(2)}, r"need the shapes .* not \(2,\), \(1, 3\), \(3,\), \(3,\)"),
        ({"goals": np.zeros(3)}, "need the shapes"),
        ({"goals": np.full((1, 3), np.nan)}, "finite"),
        ({"upper": np.array([1.0, np.inf, 1.0])}, "finite"),
        ({"lower": np.array([-1.0, 1.0, -1.0])}, "joint 1 has no room between its limits"),
        ({"resolution": 0.0}, "resolution must be above 0, not 0"),
        ({"resolution": np.nan}, "resolution must be above 0, not nan"),
    ],
)
def test_bad_input_is_answered_in_one_line(changes: dict[str, Any], what: str) -> None:
    pytest.importorskip("ompl")
    with pytest.raises(ArmError, match=what) as caught:
        ask(**changes)
    assert "\n" not in str(caught.value)


def ask(**changes: Any) -> None:
    given = {
        "start": np.zeros(3), "goals": np.zeros((1, 3)), "lower": -np.ones(3), "upper": np.ones(3), "valid": bool,
        "resolution": 0.1, "stop": bool, "rng": np.random.default_rng(0),
    }  # fmt: skip
    collision_free_path(**{**given, **changes})


@given(steps=st.integers(1, 700))
def test_an_edge_is_looked_at_in_all_places_once_the_middle_early(steps: int) -> None:
    fractions = bisection(steps)[:, 0] * steps
    np.testing.assert_allclose(np.sort(fractions), np.arange(1, steps + 1), atol=1e-9)
    assert fractions[0] == pytest.approx(steps)
    for seen in (4, 16, 64):  # no place is ever much farther from those looked at than it would be were they even
        if seen < steps:
            widest = np.diff(np.sort(np.concatenate([[0.0], fractions[:seen]]))).max()
            assert widest <= 4.0 * steps / seen + 1.0


angles = st.floats(-3.0, 3.0, allow_subnormal=False)


@given(ends=st.lists(st.lists(angles, min_size=3, max_size=3), min_size=2, max_size=2), resolution=st.floats(0.01, 1.0))
def test_no_joint_moves_by_more_than_the_resolution_between_looks(ends: list[list[float]], resolution: float) -> None:
    a, b = np.array(ends)
    seen: list[FloatArray] = [a]
    assert Edges(lambda q: not seen.append(q), resolution).allowed(a, b)  # type: ignore[func-returns-value]
    places = np.array(seen)
    assert (places[1] == b).all(), "the end first"
    along = places[np.argsort((places - a) @ (b - a), kind="stable")]
    assert np.abs(np.diff(along, axis=0)).max() <= resolution * (1.0 + 1e-6)


@settings(max_examples=60)
@given(seed=st.integers(0, 2**32), gap=st.floats(-1.0, 1.0))
def test_a_shortened_path_is_valid_no_longer_and_has_the_same_ends(seed: int, gap: float) -> None:
    valid = walls((gap, gap + 0.4))
    edges, rng = Edges(valid, RESOLUTION), np.random.default_rng(seed)
    crossing = np.array([[0.6, gap + 0.2, 0.0], [1.4, gap + 0.2, 0.0]])
    before, behind = (
        rng.uniform((0.0, -2.0, -2.0), (0.8, 2.0, 2.0), (4, 3)),
        rng.uniform((1.2, -2.0, -2.0), (2.0, 2.0, 2.0), (4, 3)),
    )
    path = np.vstack([before, crossing, behind])
    short = shortened(path, edges, rng)
    check(short, valid, start=path[0], goals=path[-1:])
    assert length(short) <= length(path) + 1e-9
    assert len(short) < len(path), "four corners on either side of one wall are never all needed"
