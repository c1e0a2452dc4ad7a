"""How a bench that is to go on differs from the one that a directory holds, and what accepts each difference."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

from phframe.bench.environment import Environment
from phframe.bench.settings import BenchSettings
from phframe.core import InputError, UnknownNameError
from phframe.core.paths import path_shown

_SHOWN = 4


class Accept(StrEnum):
    """What may differ, by what ``--accept`` calls it."""

    SUITES = "suites"
    """Problems are new, missing, or have another scene."""
    PLANNERS = "planners"
    """Planners are new or missing, or have other options."""
    OPTIONS = "options"
    """How all trials are run: backend, arm, options, limits, seeds."""
    VERSIONS = "versions"
    """Of Python, phframe, plugins or libraries."""
    CODE = "code"
    """phframe's source, a plugin's, or the file of a planner."""
    MACHINE = "machine"
    """Its processor, cores, memory or operating system: times are not to be compared."""


KIND_OF: Mapping[str, Accept | None] = {
    "suites": None,  # what they stand for is compared: the problems
    "planners": Accept.PLANNERS,
    **dict.fromkeys(("backend", "arm", "plan_backend", "plan_arm", "topology", "goal", "options"), Accept.OPTIONS),
    **dict.fromkeys(("seeds", "loop", "noise", "memory_limit", "trial_limit"), Accept.OPTIONS),
}
"""Of every field of the settings, what accepts that it differs; None: it alone changes nothing."""


@dataclass(frozen=True, slots=True)
class BenchDifference:
    """One thing in which two benches differ.

    Attributes:
        kind: What accepts it.
        what: What it is, for people.
    """

    kind: Accept
    what: str


class BenchConflictError(InputError):
    """A directory that holds another bench.

    Args:
        directory: The directory.
        differences: In what the bench that is asked for differs from it.
    """

    def __init__(self, directory: Path, differences: Sequence[BenchDifference]) -> None:
        self.directory, self.differences = directory, tuple(differences)
        kinds = dict.fromkeys(each.kind for each in differences)
        listed = "; ".join(
            f"{kind}: {', '.join(each.what for each in differences if each.kind is kind)}" for kind in kinds
        )
        flags = " ".join(f"--accept {kind}" for kind in kinds)
        super().__init__(
            f"{path_shown(directory)} holds another bench ({listed}). To go on with it all the same: {flags}; results of "
            "trials that are then no part of it are kept, but left out. Else name another directory with --out"
        )

    def __reduce__(self) -> tuple[type[BenchConflictError], tuple[Path, tuple[BenchDifference, ...]]]:
        return type(self), (self.directory, self.differences)


def setting_differences(before: BenchSettings, now: BenchSettings) -> Iterator[BenchDifference]:
    """In what the settings of two benches differ."""
    for name, kind in KIND_OF.items():
        then, wanted = (getattr(each, name) for each in (before, now))
        if kind is None or then == wanted:
            continue
        if name == "planners":
            yield from _of_sets(kind, then, wanted)
        else:
            pairs = _flat(name, then), _flat(name, wanted)
            yield from (BenchDifference(kind, what) for what in _changes(*pairs))


def problem_differences(before: Mapping[str, str], now: Mapping[str, str]) -> Iterator[BenchDifference]:
    """In which problems two benches differ, given a digest of the scene of each."""
    yield from _of_sets(Accept.SUITES, before, now)
    changed = [name for name in now if name in before and before[name] != now[name]]
    yield from _several(Accept.SUITES, changed, "changed")


def environment_differences(before: Environment, now: Environment) -> Iterator[BenchDifference]:
    """In what two environments differ. Commits are not compared: the code is."""
    yield from (BenchDifference(Accept.VERSIONS, what) for what in _changes(before.versions, now.versions))
    changed = sorted(name for name in {*before.code, *now.code} if before.code.get(name) != now.code.get(name))
    yield from (BenchDifference(Accept.CODE, f"the source of {name} is another one") for name in changed)
    machines = [{name: getattr(each, name) for name in ("system", "cpu", "cores", "memory")} for each in (before, now)]
    yield from (BenchDifference(Accept.MACHINE, what) for what in _changes(*machines))


def accepted(names: Collection[str]) -> list[Accept]:
    """What is accepted, by its names.

    Raises:
        UnknownNameError: If one is none.
    """
    known = [each.value for each in Accept]
    if unknown := [name for name in names if name not in known]:
        raise UnknownNameError("difference", unknown[0], known, "That is what --accept takes.")
    return [Accept(name) for name in names]


def refused(differences: Collection[BenchDifference], accepted: Collection[Accept]) -> list[BenchDifference]:
    """The differences that nothing accepts."""
    return [each for each in differences if each.kind not in accepted]


def _of_sets(kind: Accept, before: Collection[str], now: Collection[str]) -> Iterator[BenchDifference]:
    yield from _several(kind, [name for name in now if name not in before], "new")
    yield from _several(kind, [name for name in before if name not in now], "missing")


def _several(kind: Accept, names: Sequence[str], how: str) -> Iterator[BenchDifference]:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    if names:
        yield BenchDifference(kind, f"{how}: {' '.join(names[:_SHOWN])}{more}")


def _changes(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    for name in dict.fromkeys([*before, *now]):
        then, wanted = (each.get(name, "none") for each in (before, now))
        if then != wanted:
            yield f"{name} was {then}, is {wanted}"


def _flat(name: str, value: Any) -> dict[str, Any]:
    """A setting as single values by name."""
    if name == "options":
        return {f"{part}.{key}": each for part, given in value.items() for key, each in given.items()}
    if name == "loop":
        return asdict(value)
    return dict(value) if isinstance(value, Mapping) else {name: value}
