"""The results of one or several benches, sorted into groups within which planners can be compared."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from phframe.bench.environment import Environment
from phframe.bench.settings import BenchSettings
from phframe.bench.trial_result import TrialResult, spec_of
from phframe.core import InputError, Value

ALL = "all suites"
"""What the group of all suites of a setting is called."""
_PLANNERS_OWN = ("scene", "planner", "seed", "workers", "format", "backend", "arm", "plan_backend", "plan_arm")
"""Fields of a run that do not make a setting, or that its name begins with."""


@dataclass(frozen=True, slots=True, eq=False)
class BenchSource(Value):
    """One bench that is reported.

    Attributes:
        directory: As it was named.
        results: Of its trials.
        settings: What it runs; None: not known.
        environments: Where its trials ran, by id.
    """

    directory: str
    results: tuple[TrialResult, ...]
    settings: BenchSettings | None = None
    environments: Mapping[str, Environment] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Group(Value):
    """What can be compared: trials of one suite, or of all, carried out in one setting.

    Attributes:
        suite: The suite, or ``ALL``.
        setting: What the plans were carried out in, and whatever else differs between settings.
        by_planner: The results of each planner, planners sorted by name.
    """

    suite: str
    setting: str
    by_planner: Mapping[str, tuple[TrialResult, ...]]

    @property
    def name(self) -> str:
        """For headings."""
        return f"{self.suite}, {self.setting}"


@dataclass(frozen=True, slots=True, eq=False)
class ReportData(Value):
    """What a report is made of.

    Attributes:
        sources: The benches.
        groups: One for each suite in each setting, and one for all suites where a setting has several.
        limits: The limit of planning (s) of each trial, by its key.
        homes: The directory of each trial, by its key.
        repeated: How many trials were in more than one bench; the first counts.
    """

    sources: tuple[BenchSource, ...]
    groups: tuple[Group, ...]
    limits: Mapping[str, float]
    homes: Mapping[str, str]
    repeated: int

    @property
    def planners(self) -> tuple[str, ...]:
        """All planners, sorted by name."""
        return tuple(sorted({planner for group in self.groups for planner in group.by_planner}))

    @property
    def settings(self) -> tuple[tuple[str, tuple[Group, ...]], ...]:
        """Each setting with its groups of one suite."""
        names = dict.fromkeys(group.setting for group in self.groups)
        of = {name: tuple(g for g in self.groups if g.setting == name and g.suite != ALL) for name in names}
        return tuple(of.items())

    @property
    def results(self) -> list[TrialResult]:
        """All results, each once, their planners as the report calls them."""
        return [r for _, groups in self.settings for group in groups for of in group.by_planner.values() for r in of]


def gather(sources: Sequence[BenchSource]) -> ReportData:
    """Sort results into groups.

    Settings differ in backend, arm, what is planned in, and whatever else of a run is not the planner's, the scene or the
    seed. The limit of planning may differ between planners; where one planner has several, each is a planner of its own.

    Raises:
        InputError: If there are no results at all.
    """
    results, homes = _each_once(sources)
    if not results:
        named = " and ".join(source.directory for source in sources)
        raise InputError(f"{named}: no trial has a result yet, so there is nothing to report. Run the bench first.")
    specs = {result.key: _spec(result) for result in results}
    limits = {key: float(spec.get("loop", {}).get("time_limit", 300.0)) for key, spec in specs.items()}
    named_settings = _setting_names(results, specs)
    renamed = _with_limits(results, named_settings, limits)
    found: dict[tuple[str, str], dict[str, list[TrialResult]]] = defaultdict(lambda: defaultdict(list))
    for result in renamed:
        found[named_settings[result.key], result.suite][result.planner].append(result)
    groups = tuple(_groups(found))
    repeated = sum(len(source.results) for source in sources) - len(results)
    return ReportData(tuple(sources), groups, limits, homes, repeated)


def _each_once(sources: Iterable[BenchSource]) -> tuple[list[TrialResult], dict[str, str]]:
    results, homes = [], {}
    for source in sources:
        for result in source.results:
            if result.key not in homes:
                homes[result.key] = source.directory
                results.append(result)
    return results, homes


def _groups(found: Mapping[tuple[str, str], Mapping[str, list[TrialResult]]]) -> Iterable[Group]:
    for setting in sorted({setting for setting, _ in found}):
        suites = {suite: found[setting, suite] for named, suite in sorted(found) if named == setting}
        if len(suites) > 1:
            planners = sorted({planner for of in suites.values() for planner in of})
            yield Group(ALL, setting, {p: tuple(r for of in suites.values() for r in of.get(p, ())) for p in planners})
        for suite, of in suites.items():
            yield Group(suite, setting, {planner: tuple(of[planner]) for planner in sorted(of)})


def _spec(result: TrialResult) -> Mapping[str, Any]:
    spec_of(result)  # refuses what is no run
    spec: Mapping[str, Any] = json.loads(result.spec)
    return spec


def _setting_names(results: Sequence[TrialResult], specs: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """The setting of each trial, by its key: engine and arm, and what else is not the same in all trials."""
    flat = {key: _flat(spec) for key, spec in specs.items()}
    distinct = {json.dumps(each, sort_keys=True): each for each in flat.values()}
    fields = sorted({name for each in distinct.values() for name in each})
    varying = [name for name in fields if len({json.dumps(each.get(name)) for each in distinct.values()}) > 1]
    return {result.key: _setting_name(result, flat[result.key], varying) for result in results}


def _setting_name(result: TrialResult, flat: Mapping[str, Any], varying: Sequence[str]) -> str:
    planned_in, planned_with = result.plan_backend or result.backend, result.plan_arm or result.arm
    name = f"{result.backend} with {result.arm}"
    if (planned_in, planned_with) != (result.backend, result.arm):
        name += f", planned in {planned_in}" + (f" with {planned_with}" if planned_with != result.arm else "")
    return ", ".join([name, *(f"{field} {flat[field]}" for field in varying if flat.get(field) is not None)])


def _flat(spec: Mapping[str, Any]) -> dict[str, Any]:
    """What makes a setting, as fields with dots."""
    flat = {}
    for name, value in spec.items():
        if name == "options":
            parts = {part: given for part, given in value.items() if part != "planner"}
            flat.update({f"{part}.{key}": each for part, given in parts.items() for key, each in given.items()})
        elif isinstance(value, dict):
            flat.update({f"{name}.{key}": each for key, each in value.items() if key != "time_limit"})
        elif name not in _PLANNERS_OWN:
            flat[name] = value
    return flat


def _with_limits(
    results: Sequence[TrialResult], settings: Mapping[str, str], limits: Mapping[str, float]
) -> list[TrialResult]:
    """The results, with the limit in the name of every planner that has several in a setting."""
    found: dict[tuple[str, str], set[float]] = defaultdict(set)
    for result in results:
        found[settings[result.key], result.planner].add(limits[result.key])
    return [
        replace(result, planner=f"{result.planner} ({limits[result.key]:g} s)")
        if len(found[settings[result.key], result.planner]) > 1
        else result
        for result in results
    ]
