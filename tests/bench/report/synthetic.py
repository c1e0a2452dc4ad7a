"""Results of a bench made up from a seed: plausible figures for the report, no measurements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import RunSpec
from phframe.core.run_spec import Loop
from phframe.core.variant import split_variant

SKILL = {
    "phia": (0.93, 0.03, 2.6), "phia[sweeps=paper]": (0.6, 0.02, 2.3), "phis": (0.95, 0.06, 1.9),
    "phim": (0.93, 0.12, 1.8), "ooa": (0.87, 0.05, 5.0), "grtc-straight": (0.62, 0.12, 3.1),
    "random-push": (0.74, 0.09, 4.4), "grtc-kinodynamic": (0.35, 22.0, 3.4), "kinodynamic-rrt": (0.25, 31.0, 4.1),
}  # fmt: skip
"""Of each planner: how often it retrieves, its typical planning time (s), its mean number of pushes."""
SUITES = {"paper": 121, "dense": 40, "near": 40}
REASONS = (
    "the corridor is not empty: no sweep fits beside o3 and o12",
    "grasp blocked by o7",
    "nothing moved: o5 is stuck against the north wall",
    "no progress in 5 pushes",
)


def synthetic(
    planners: Sequence[str] = tuple(SKILL),
    suites: dict[str, int] | None = None,
    seeds: int = 1,
    backend: str = "pymunk",
    arm: str = "planar",
    time_limit: float = 60.0,
) -> Iterator[TrialResult]:
    """Results of all planners on all problems of some suites."""
    for suite, count in (suites or SUITES).items():
        for number in range(count):
            hardness = np.random.default_rng([len(suite), number]).random()
            for planner in planners:
                for seed in range(seeds):
                    yield _result(planner, suite, number, seed, backend, arm, time_limit, hardness)


def _result(
    planner: str, suite: str, number: int, seed: int, backend: str, arm: str, limit: float, hardness: float
) -> TrialResult:
    skill, typical, pushes = SKILL.get(planner, (0.5, 0.1, 3.0))
    rng = np.random.default_rng([sum(map(ord, planner)), len(suite), number, seed, len(backend)])
    won = bool(hardness * 0.5 + rng.random() * 0.5 < skill)
    time = float(rng.lognormal(np.log(typical), 0.6) * (0.5 + hardness))
    killed, crashed = time > limit or rng.random() < 0.004, rng.random() < 0.003
    end = TrialEnd.KILLED if killed else TrialEnd.CRASHED if crashed else TrialEnd.FINISHED
    scene, (name, options) = f"{suite}/{number:03d}", split_variant(planner)
    spec = RunSpec(
        scene, name, backend, arm, "pymunk", arm, options={"planner": options}, seed=seed, loop=Loop(time_limit=limit)
    )
    head = TrialResult(
        spec.key(), suite, scene, planner, backend, arm, "pymunk", arm, seed, spec.to_json(), end,
        started="2026-11-25T12:00:00+00:00", environment="e0",
    )  # fmt: skip
    if end is not TrialEnd.FINISHED:
        why = f"killed after {limit * 1.5 + 60:g} s" if killed else "died by signal 11"
        return _with(head, reason=why, wall_time=limit if killed else time)
    actions = int(rng.poisson(max(pushes - 1, 0.1)) + 1)
    topples = int(rng.random() < 0.05)
    claims = won or rng.random() < 0.3
    return _with(
        head,
        claimed="retrieved" if claims else "failed",
        status="retrieved" if won else ("reached" if claims and rng.random() < 0.5 else "failed"),
        reason="" if won else REASONS[int(rng.integers(len(REASONS)))],
        retrieved=won, clean=won and not topples, pushes=actions if won else int(rng.integers(0, 6)),
        replans=int(rng.integers(0, 2)), rejections=int(rng.integers(0, 2)), simulations=3 * actions,
        planning_time=time, topology_time=0.05 * time * rng.random(), simulation_time=time * (0.6 + 0.2 * rng.random()),
        motion_planning_time=0.0 if arm == "planar" else float(rng.lognormal(-1, 0.3)) * actions,
        first_solution_time=0.9 * time if claims else None, execution_time=5.0 + 3.2 * actions + float(rng.random()),
        displacement=float(rng.exponential(0.2)), largest_displacement=float(rng.exponential(0.1)), toppled=topples,
        spilled=int(rng.random() < 0.02), target_moved=float(rng.exponential(0.005)),
        wall_contact=bool(rng.random() < 0.03), largest_force=float(rng.exponential(10)),
        tracking_error=float(rng.exponential(0.001)),
        prediction_error=None if backend == "pymunk" and rng.random() < 0.1 else float(rng.exponential(0.004)),
        largest_prediction_error=float(rng.exponential(0.02)),
        deviations={"fallback radius": 1, "arm tilted": actions} if planner.startswith("phi") else {},
        wall_time=time + 0.4, peak_memory=int(2e8),
    )  # fmt: skip


def _with(result: TrialResult, **changes: object) -> TrialResult:
    from dataclasses import replace

    return replace(result, **changes)  # type: ignore[arg-type]
