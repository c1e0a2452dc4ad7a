"""What is told of a planner in a group: rates, means and medians with their intervals."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from phframe.bench.report.data import Group, ReportData
from phframe.bench.statistics import Estimate, success_rate, typical
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import Status

GOAL_MET = (Status.RETRIEVED, Status.ACHIEVED)
AT_GRASP = (*GOAL_MET, Status.REACHED)
"""The paper's success: the gripper was at a grasp pose with the link free."""


@dataclass(frozen=True, slots=True)
class PlannerSummary:
    """A planner in a group. Means and medians are over scenes, of the trials that are named.

    Attributes:
        planner: Its name.
        trials: How many trials it had.
        retrieved: Rate of those in which the goal was met, as the referee saw it.
        reached: How many had the gripper at a grasp pose at least.
        clean: How many were clean.
        lost: How many gave no episode: killed, crashed, out of memory, an error.
        planning: Mean planning time of trials that retrieved (s).
        planning_median: Median planning time of all trials that gave an episode (s).
        execution: Mean execution time of trials that retrieved (s).
        actions: Mean number of pushes of trials that retrieved.
        simulations: Mean number of simulated actions of trials that gave an episode.
    """

    planner: str
    trials: int
    retrieved: Estimate
    reached: int
    clean: int
    lost: int
    planning: Estimate
    planning_median: Estimate
    execution: Estimate
    actions: Estimate
    simulations: Estimate

    @property
    def reached_rate(self) -> float:
        """Fraction of trials that had the gripper at a grasp pose at least."""
        return self.reached / self.trials


@dataclass(frozen=True, slots=True, eq=False)
class GroupSummary:
    """A group and what is told of its planners, in the group's order."""

    group: Group
    planners: tuple[PlannerSummary, ...]


def summarise(data: ReportData) -> tuple[GroupSummary, ...]:
    """All groups."""
    return tuple(
        GroupSummary(group, tuple(_planner(name, results) for name, results in group.by_planner.items()))
        for group in data.groups
    )


def finished(results: Iterable[TrialResult]) -> list[TrialResult]:
    """Those that gave an episode."""
    return [result for result in results if result.end is TrialEnd.FINISHED]


def strata(
    results: Iterable[TrialResult], figure: Callable[[TrialResult], Any]
) -> Sequence[Mapping[str, Sequence[float]]]:
    """A figure of each trial by scene, for each suite."""
    found: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for result in results:
        found[result.suite][result.problem].append(float(figure(result)))
    return list(found.values())


def _planner(name: str, results: Sequence[TrialResult]) -> PlannerSummary:
    won: dict[str, list[bool]] = defaultdict(list)
    for result in results:
        won[f"{result.suite} {result.problem}"].append(result.retrieved)
    solved, told = [result for result in results if result.retrieved], finished(results)
    return PlannerSummary(
        planner=name,
        trials=len(results),
        retrieved=success_rate(won),
        reached=sum(result.status in AT_GRASP for result in results),
        clean=sum(result.clean for result in results),
        lost=len(results) - len(told),
        planning=typical(strata(solved, lambda r: r.planning_time)),
        planning_median=typical(strata(told, lambda r: r.planning_time), "median"),
        execution=typical(strata(solved, lambda r: r.execution_time)),
        actions=typical(strata(solved, lambda r: r.pushes)),
        simulations=typical(strata(told, lambda r: r.simulations)),
    )
