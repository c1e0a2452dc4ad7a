"""In what benches differ that are to be one, told with what accepts it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace

from phframe.bench.conflicts import (
    BenchDifference,
    environment_differences,
    problem_differences,
    setting_differences,
)
from phframe.bench.environment import Environment
from phframe.bench.store import ResultStore
from phframe.bench.trial_result import TrialResult
from phframe.core import InputError

TIMED = frozenset(
    {"planning_time", "topology_time", "simulation_time", "motion_planning_time", "first_solution_time", "wall_time"}
    | {"peak_memory", "started", "environment"}
)
"""Fields of a result that a repetition need not give again."""
SHOWN = 4
"""Differences that a refusal spells out."""
_LONGEST = 60
"""Characters of a value in a difference."""


@dataclass(frozen=True, slots=True)
class ResultDifference:
    """A field in which two results of one trial differ.

    Attributes:
        key: Of the trial.
        what: The field and the trial, for people.
        first: Its value in the bench that was given before.
        second: Its value in the other one.
    """

    key: str
    what: str
    first: str
    second: str

    def __str__(self) -> str:
        return f"{self.what} is {_short(self.first)} and {_short(self.second)}"


class MergeConflictError(InputError):
    """Benches that differ in what was not accepted.

    Args:
        differences: In what they differ.
    """

    def __init__(self, differences: Sequence[BenchDifference]) -> None:
        self.differences = tuple(differences)
        kinds = dict.fromkeys(each.kind for each in self.differences)
        listed = "; ".join(f"{each.kind}: {each.what}" for each in self.differences[:SHOWN])
        flags = " ".join(f"--accept {kind}" for kind in kinds)
        super().__init__(
            f"these benches differ ({listed}{_more(len(self.differences))}). To merge them all the same: {flags}; of the "
            "settings the first one's count"
        )

    def __reduce__(self) -> tuple[type[MergeConflictError], tuple[tuple[BenchDifference, ...]]]:
        return type(self), (self.differences,)


class ResultConflictError(InputError):
    """Trials that came out differently in different benches.

    Args:
        differences: The first of them.
        count: How many there are.
    """

    def __init__(self, differences: Sequence[ResultDifference], count: int) -> None:
        self.differences, self.count = tuple(differences), count
        listed = "; ".join(map(str, self.differences[:SHOWN]))
        super().__init__(
            f"these benches contradict each other: {listed}{_more(count)}. Say whose results to take: --prefer first or "
            "--prefer last"
        )

    def __reduce__(self) -> tuple[type[ResultConflictError], tuple[tuple[ResultDifference, ...], int]]:
        return type(self), (self.differences, self.count)


def bench_differences(one: ResultStore, other: ResultStore) -> Iterator[BenchDifference]:
    """In what two benches differ, their results aside; that they have other suites, planners and seeds is no difference."""
    first, second = one.settings, other.settings
    same_trials = {name: getattr(first, name) for name in ("suites", "planners", "seeds")}
    yield from setting_differences(first, replace(second, **same_trials))
    yield from problem_differences(*_common(one.problems(), other.problems()))
    known = one.environments()
    for name, environment in other.environments().items():
        if known and name not in known:
            yield from environment_differences(*_comparable(list(known.values())[-1], environment))


def result_differences(first: TrialResult, second: TrialResult) -> Iterator[ResultDifference]:
    """In what two results of one trial differ, times aside."""
    trial = f"of {first.planner} on {first.problem} with seed {first.seed}"
    for name in (each.name for each in fields(TrialResult) if each.name not in TIMED | {"spec"}):
        one, other = getattr(first, name), getattr(second, name)
        if one != other:
            yield ResultDifference(first.key, f"{name} {trial}", str(one), str(other))


def _common(one: Mapping[str, str], other: Mapping[str, str]) -> tuple[dict[str, str], dict[str, str]]:
    """What is in both: other trials need other plugins and scenes."""
    names = [name for name in one if name in other]
    return {name: one[name] for name in names}, {name: other[name] for name in names}


def _comparable(one: Environment, other: Environment) -> tuple[Environment, Environment]:
    versions, code = _common(one.versions, other.versions), _common(one.code, other.code)
    first, second = (replace(each, versions=versions[n], code=code[n]) for n, each in enumerate((one, other)))
    return first, second


def _more(count: int) -> str:
    return f"; and {count - SHOWN} more" if count > SHOWN else ""


def _short(text: str) -> str:
    line = " ".join(text.split()) or "empty"
    return line if len(line) <= _LONGEST else f"{line[:_LONGEST]}..."
