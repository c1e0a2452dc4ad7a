"""A bench in a few lines: for every planner and suite how many targets were retrieved, how surely, and at what cost."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from statistics import fmean, median

from phframe.bench.trial_result import TrialEnd, TrialResult


@dataclass(frozen=True, slots=True)
class SummaryLine:
    """One planner on one suite.

    Attributes:
        planner: With its options.
        suite: The suite.
        trials: How many have a result.
        retrieved: How many met the goal.
        clean: How many of these left everything else in order.
        failures: How many crashed, were killed, ran out of memory or had an error.
        low: Lower end of the interval of the rate of retrieval, as ``success_rate`` has it: seeds do not count as scenes.
        high: Its upper end.
        pushes: Mean number of pushes where the goal was met; None: it never was.
        planning_time: Median planning time of the trials that gave an episode (s); None: none did.
    """

    planner: str
    suite: str
    trials: int
    retrieved: int
    clean: int
    failures: int
    low: float
    high: float
    pushes: float | None
    planning_time: float | None


@dataclass(slots=True)
class SummaryTally:
    """What is counted while results come in."""

    by_scene: defaultdict[str, list[bool]] = field(default_factory=lambda: defaultdict(list))
    clean: int = 0
    failures: int = 0
    pushes: list[int] = field(default_factory=list)
    planning_times: list[float] = field(default_factory=list)

    def count(self, result: TrialResult) -> None:
        """Count one more."""
        finished = result.end is TrialEnd.FINISHED
        self.by_scene[result.problem].append(result.retrieved)
        self.clean += result.clean
        self.failures += not finished
        self.pushes += [result.pushes] if result.retrieved else []
        self.planning_times += [result.planning_time] if finished else []


def summary(results: Iterable[TrialResult]) -> list[SummaryLine]:
    """A line for every planner and suite that has a result, by planner, then suite."""
    tallies: dict[tuple[str, str], SummaryTally] = {}
    for result in results:
        tallies.setdefault((result.planner, result.suite), SummaryTally()).count(result)
    return [_line(*key, tallies[key]) for key in sorted(tallies)]


def _line(planner: str, suite: str, tally: SummaryTally) -> SummaryLine:
    from phframe.bench.statistics import success_rate  # scipy takes a second to import

    rate = success_rate(tally.by_scene)
    assert rate.low is not None, "there is a line only for what has results"
    assert rate.high is not None
    pushes = fmean(tally.pushes) if tally.pushes else None
    seconds = median(tally.planning_times) if tally.planning_times else None
    retrieved = sum(map(sum, tally.by_scene.values()))
    counts = rate.trials, retrieved, tally.clean, tally.failures
    return SummaryLine(planner, suite, *counts, rate.low, rate.high, pushes, seconds)
