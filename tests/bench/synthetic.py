"""Results of trials that nobody ran: the same ones for the same seed, and hostile ones for hypothesis."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from phframe.bench.environment import Environment
from phframe.bench.settings import BenchSettings
from phframe.bench.store import ResultStore
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import Loop, RunSpec

SETTINGS = BenchSettings(("vieira",), ("phia", "ooa"), seeds=3, loop=Loop(time_limit=30.0))
ENVIRONMENT = Environment(
    {"phframe": "0.1.0", "python": "3.11"}, "0123abc", {"phframe": "same"}, cpu="A processor", cores=2, memory=8000
)
HOSTILE = (
    "two\nlines\r, a \"quote\", 'another', a comma, \ttabs\\n, ünï¢ödé, NUL \0, half a surrogate \udc80 \u2028 <b>"
)
SPEC = json.loads(RunSpec().to_json())
PLANNERS = ("phia", "phia[sweeps=paper]", "ooa", "random")


def synthetic_result(number: int, *, seed: int = 0) -> TrialResult:
    """One result: the same for the same number and seed."""
    rng = np.random.default_rng((seed, number))
    planner, problem = PLANNERS[number % 4], f"random/{number // 4 % 100:03d}"
    spec = {**SPEC, "scene": problem, "planner": planner.partition("[")[0], "seed": number // 400}
    end = (TrialEnd.FINISHED, TrialEnd.FINISHED, *TrialEnd)[int(rng.integers(7))]
    ended, retrieved = end is TrialEnd.FINISHED, end is TrialEnd.FINISHED and bool(rng.random() < 0.7)
    return TrialResult(
        key=f"{seed:08x}{number:024x}",
        suite="paper",
        problem=problem,
        planner=planner,
        backend="pymunk",
        arm="planar",
        plan_backend="pymunk",
        plan_arm="planar",
        seed=number // 400,
        spec=json.dumps(spec),
        end=end,
        claimed="retrieved" if ended else "",
        status=("retrieved" if retrieved else "failed") if ended else "",
        reason="" if retrieved else f'no push of "{number}" is left, none\nis free',
        retrieved=retrieved,
        clean=retrieved and bool(rng.random() < 0.9),
        pushes=int(rng.integers(9)),
        simulations=int(rng.integers(400)),
        planning_time=float(rng.exponential(0.1)),
        first_solution_time=float(rng.exponential(0.1)) if retrieved else None,
        execution_time=float(rng.exponential(20.0)),
        displacement=float(rng.exponential(0.3)),
        wall_contact=bool(rng.random() < 0.1),
        largest_force=float(rng.exponential(4.0)),
        deviations={"second try": int(rng.integers(1, 4))} if rng.random() < 0.3 else {},
        wall_time=float(rng.exponential(1.0)),
        peak_memory=int(rng.integers(1 << 28)),
        started="2026-01-01T00:00:00+00:00",
        environment=ENVIRONMENT.id,
    )


def synthetic_results(count: int, *, seed: int = 0) -> Iterator[TrialResult]:
    """That many results, one by one."""
    return (synthetic_result(number, seed=seed) for number in range(count))


def hostile_result() -> TrialResult:
    """A result whose texts hold what breaks naive writers."""
    result = synthetic_result(7)
    return replace(result, reason=HOSTILE, planner=f"x[{HOSTILE}]", deviations={HOSTILE: 3}, largest_force=float("inf"))


def written_store(folder: Path, results: list[TrialResult], settings: BenchSettings = SETTINGS) -> Path:
    """The directory of a bench that holds these results."""
    with ResultStore.create(folder, settings, {}) as store:
        store.add_environment(ENVIRONMENT)
        for result in results:
            store.add(result)
    return folder


_TEXTS = st.text(st.characters(categories=None), max_size=12)  # surrogates and zeros too
_FLOATS = st.floats(allow_nan=False)
_COUNTS = st.integers(0, 2**62)


@st.composite
def any_result(draw: st.DrawFn) -> TrialResult:
    """A result with any texts and numbers."""
    return replace(
        synthetic_result(draw(st.integers(0, 99))),
        key=draw(_TEXTS),
        problem=draw(_TEXTS),
        planner=draw(_TEXTS),
        reason=draw(_TEXTS),
        started=draw(_TEXTS),
        planning_time=draw(_FLOATS),
        largest_force=draw(_FLOATS),
        first_solution_time=draw(st.none() | _FLOATS),
        peak_memory=draw(_COUNTS),
        deviations=draw(st.dictionaries(_TEXTS, _COUNTS, max_size=3)),
    )
