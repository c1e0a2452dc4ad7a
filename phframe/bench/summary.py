"""A bench in a few lines: for every planner and suite how many targets were retrieved, how surely, and at what cost."""

from __future__ import annotations

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
        low: Lower end of the Wilson interval of the rate of retrieval.
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

    trials: int = 0
    retrieved: int = 0
    clean: int = 0
    failures: int = 0
    pushes: list[int] = field(default_factory=list)
    planning_times: list[float] = field(default_factory=list)

    def count(self, result: TrialResult) -> None:
        """Count one more."""
        finished = result.end is TrialEnd.FINISHED
        self.trials += 1
        self.retrieved += result.retrieved
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
    from phframe.bench.statistics import wilson  # scipy takes a second to import

    low, high = wilson(tally.retrieved, tally.trials)
    pushes = fmean(tally.pushes) if tally.pushes else None
    seconds = median(tally.planning_times) if tally.planning_times else None
    counts = tally.trials, tally.retrieved, tally.clean, tally.failures
    return SummaryLine(planner, suite, *counts, low, high, pushes, seconds)
