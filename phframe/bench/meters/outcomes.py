"""How planners do on the published suites."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import mean, median

from phframe.core import Episode, Status
from phframe.pushing import PushDecision, is_cleared
from phframe.runtime.solve import solve

REACHED = (Status.REACHED, Status.RETRIEVED)


@dataclass(frozen=True, slots=True)
class Outcome:
    """One planner on one scene.

    Attributes:
        suite: Of the scene.
        scene: Its name.
        episode: What came of it.
    """

    suite: str
    scene: str
    episode: Episode


@dataclass(frozen=True, slots=True)
class Tally:
    """One planner on one suite.

    Attributes:
        planner: Its name.
        suite: Its name.
        scenes: How many.
        cleared: In how many the corridor was empty in the end.
        reached: In how many the gripper was at a grasp pose.
        retrieved: In how many the target was drawn out.
        clean: In how many of those nothing toppled or spilled and no wall was touched.
        actions: Mean number of pushes, of the scenes that were retrieved.
        planning_time: Median wall time (s).
        motion_planning_time: Median wall time of planning joint trajectories (s).
        execution_time: Median simulated time (s), of the scenes that were retrieved.
    """

    planner: str
    suite: str
    scenes: int
    cleared: int
    reached: int
    retrieved: int
    clean: int
    actions: float
    planning_time: float
    motion_planning_time: float
    execution_time: float


def run_suite(
    planner: str,
    scenes: Sequence[str],
    tell: Callable[[str], None],
    *,
    backend: str = "pymunk",
    arm: str = "planar",
) -> list[Outcome]:
    """Solve every scene, each called ``suite/name``, with seed 0.

    Raises:
        PhframeError: If backend or arm do not exist, are not installed or cannot go together.
    """
    outcomes = []
    for name in scenes:
        tell(f"{planner} {name}")
        outcomes.append(Outcome(name.partition("/")[0], name, solve(name, planner=planner, backend=backend, arm=arm)))
    return outcomes


def tally(planner: str, suite: str, outcomes: Sequence[Outcome]) -> Tally:
    """Sum up one suite."""
    episodes = [outcome.episode for outcome in outcomes]
    retrieved = [episode for episode in episodes if episode.status is Status.RETRIEVED]
    return Tally(
        planner,
        suite,
        scenes=len(episodes),
        cleared=sum(map(was_cleared, episodes)),
        reached=sum(episode.status in REACHED for episode in episodes),
        retrieved=len(retrieved),
        clean=sum(episode.clean for episode in episodes),
        actions=mean([episode.pushes for episode in retrieved] or [0]),
        planning_time=median(episode.cost.total for episode in episodes),
        motion_planning_time=median(episode.motion_planning_time for episode in episodes),
        execution_time=median([episode.execution_time for episode in retrieved] or [0.0]),
    )


def was_cleared(episode: Episode) -> bool:
    """Whether the corridor was empty in the end: in the world, or, where a failed plan was not executed, in the plan."""
    if episode.status in (*REACHED, Status.CLEARED):
        return True
    plan = episode.plans[-1]
    found = (PushDecision.of(decision).corridor for decision in plan.decisions)
    corridors = [corridor for corridor in found if corridor is not None]
    return bool(plan.expected and corridors) and is_cleared(episode.scene, plan.expected[-1], corridors[-1].half_width)


def deviations(outcomes: Sequence[Outcome]) -> Counter[str]:
    """How often phframe's deviations of what the paper leaves open were used, over all plans."""
    return sum((plan.deviations for outcome in outcomes for plan in outcome.episode.plans), Counter())
