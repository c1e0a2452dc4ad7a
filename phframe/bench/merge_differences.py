"""In what benches differ that are to be one, told with the flag that accepts it."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from enum import StrEnum

from phframe.bench.environment import Environment
from phframe.bench.settings import BenchSettings
from phframe.bench.trial_result import TrialResult
from phframe.core import InputError

SUMMED = ("suites", "planners", "seeds")
"""Settings that say which trials there are: those of all benches count."""
TIMED = frozenset(
    {"planning_time", "topology_time", "simulation_time", "motion_planning_time", "first_solution_time", "wall_time"}
    | {"peak_memory", "started", "environment"}
)
"""Fields of a result that a repetition need not give again."""
SHOWN = 4
"""Differences that a refusal spells out."""
_LONGEST = 60
"""Characters of a value in a difference."""


class MergeKind(StrEnum):
    """In what benches differ."""

    SETTINGS = "settings"
    VERSIONS = "versions"
    CODE = "code"
    PROBLEMS = "problems"
    RESULTS = "results"


@dataclass(frozen=True, slots=True)
class MergeDifference:
    """Something in which two benches differ.

    Attributes:
        kind: What it is.
        what: Whose: a setting, a distribution, a problem, a trial and one of its fields.
        first: What it is in the benches that were given before.
        second: What it is in this one.
    """

    kind: MergeKind
    what: str
    first: str
    second: str

    @property
    def flag(self) -> str:
        """The flag that accepts it."""
        return "--prefer first or last" if self.kind is MergeKind.RESULTS else f"--accept {self.kind}"

    def __str__(self) -> str:
        return f"{self.what} is {_short(self.first)} and {_short(self.second)} [{self.flag}]"


class MergeRefusedError(InputError):
    """Benches that differ in what was not accepted.

    Args:
        differences: The first of them.
        count: How many there are.
    """

    def __init__(self, differences: Sequence[MergeDifference], count: int) -> None:
        self.differences, self.count = tuple(differences), count
        shown = "; ".join(map(str, self.differences[:SHOWN]))
        more = f"; and {count - SHOWN} more" if count > SHOWN else ""
        super().__init__(f"these benches differ, and nothing was written: {shown}{more}")

    def __reduce__(self) -> tuple[type[MergeRefusedError], tuple[tuple[MergeDifference, ...], int]]:
        return type(self), (self.differences, self.count)


def setting_differences(first: BenchSettings, second: BenchSettings) -> Iterator[MergeDifference]:
    """The settings that change what a trial is, where they differ."""
    one, other = json.loads(first.to_json()), json.loads(second.to_json())
    for name in sorted(one):
        if name not in SUMMED and one[name] != other[name]:
            yield MergeDifference(MergeKind.SETTINGS, name, json.dumps(one[name]), json.dumps(other[name]))


def environment_differences(first: Iterable[Environment], second: Iterable[Environment]) -> Iterator[MergeDifference]:
    """The versions and code that both have used, where they are not the same. Machines may differ."""
    one, other = list(first), list(second)
    for kind, used in ((MergeKind.VERSIONS, _versions), (MergeKind.CODE, _code)):
        here, there = used(one), used(other)
        for name in sorted(here.keys() & there.keys()):
            if here[name] != there[name]:
                yield MergeDifference(kind, name, _listed(here[name]), _listed(there[name]))


def problem_differences(first: Mapping[str, str], second: Mapping[str, str]) -> Iterator[MergeDifference]:
    """The scenes of one name that are not the same."""
    for name in sorted(first.keys() & second.keys()):
        if first[name] != second[name]:
            yield MergeDifference(MergeKind.PROBLEMS, f"the scene {name}", first[name], second[name])


def result_differences(first: TrialResult, second: TrialResult) -> Iterator[MergeDifference]:
    """In what two results of one trial differ, times aside."""
    trial = f"of trial {first.key} ({first.planner} on {first.problem}, seed {first.seed})"
    for name in (each.name for each in fields(TrialResult) if each.name not in TIMED | {"spec"}):
        one, other = getattr(first, name), getattr(second, name)
        if one != other and not (one != one and other != other):
            yield MergeDifference(MergeKind.RESULTS, f"{name} {trial}", str(one), str(other))


def _versions(environments: Iterable[Environment]) -> dict[str, set[str]]:
    used = defaultdict(set)
    for environment in environments:
        for name, version in environment.versions.items():
            used[name].add(version)
    return used


def _code(environments: Iterable[Environment]) -> dict[str, set[str]]:
    used = defaultdict(set)
    for environment in environments:
        for name, digest in environment.code.items():
            used[name].add(digest)
    return used


def _listed(values: Iterable[str]) -> str:
    return " or ".join(sorted(values))


def _short(text: str) -> str:
    line = " ".join(text.split()) or "empty"
    return line if len(line) <= _LONGEST else f"{line[:_LONGEST]}..."
