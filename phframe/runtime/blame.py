"""Which part of a run an exception comes from, so that the message names the plugin and not the user."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import PurePath
from traceback import extract_tb, walk_tb
from typing import Any

from phframe.core import PhframeError, RunSpec, SimulationDivergedError
from phframe.core.errors import BudgetExceededError, NotInstalledError, PartFailedError, error_text
from phframe.core.run_spec import PARTS
from phframe.core.variant import split_variant
from phframe.registry import Kind, catalogue, load

HOME = "phframe"
_OUTCOMES = (BudgetExceededError, SimulationDivergedError, NotInstalledError, MemoryError)
"""Exceptions that say what happened whoever raised them."""


@dataclass(frozen=True, slots=True)
class ForeignPart:
    """A part of a run that is none of phframe's own.

    Attributes:
        package: The top-level package that its code is in.
        title: What it is, its name, and the distribution and version it comes from.
    """

    package: str
    title: str


def is_own(part: Any) -> bool:
    """Whether a class, or an object's class, is phframe's own; of one that wraps another (``__wrapped__``), whether that is."""
    part = getattr(part, "__wrapped__", part)
    return package_of(part) == HOME


def package_of(part: Any) -> str:
    """The top-level package of a class, or of an object's class."""
    return str((part if isinstance(part, type) else type(part)).__module__).partition(".")[0]


def title_of(kind: Kind, part: Any) -> str:
    """A part for people: ``planner 'mine' of lab-push 1.0``; of a class that is not registered, its name."""
    if isinstance(part, str):
        plain, _ = split_variant(part)
        entry = catalogue().entry(kind, plain)
        name = plain if entry else plain.rpartition(":")[2]
    else:
        part = getattr(part, "__wrapped__", part)
        target = part if isinstance(part, type) else type(part)
        whole = f"{target.__module__}:{target.__qualname__}"
        entry = next((each for each in catalogue().extensions(kind) if each.extension.target == whole), None)
        name = entry.name if entry else target.__name__
    return f"{kind} {name!r}" + (f" of {entry.distribution} {entry.version}".rstrip() if entry else "")


@contextmanager
def blaming(spec: RunSpec) -> Iterator[None]:
    """Have what a part of a run raises said to be of that part; what the system or a user does passes as it is.

    Raises:
        PartFailedError: In place of an exception that came from code which is not phframe's, or of a ``SystemExit``.
    """
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        told = blamed(error, spec)
        if told is error:
            raise
        raise told from error


def blamed(error: BaseException, spec: RunSpec) -> BaseException:
    """The exception as it is to be told: the same, or one that names the part which it comes from."""
    if isinstance(error, (PartFailedError, KeyboardInterrupt, *_OUTCOMES)):
        return error
    culprit = _culprit(error, parts_of(spec))
    if culprit is None and isinstance(error, Exception):
        return error
    return PartFailedError(f"{culprit.title if culprit else 'a part of the run'} {_deed(error, culprit)}")


def parts_of(spec: RunSpec) -> list[ForeignPart]:
    """The parts of a run that are not phframe's own, as far as they can be loaded."""
    named = [(Kind(part.removeprefix("plan_")), getattr(spec, part)) for part in PARTS]
    if isinstance(spec.scene, str) and "/" in spec.scene and not spec.scene.endswith((".yaml", ".yml")):
        named.append((Kind.SCENES, type(spec.scene)(spec.scene.partition("/")[0])))  # a name from a file remains one
    found = []
    for kind, part in named:
        try:
            own = part is None or is_own(load(kind, part) if isinstance(part, str) else part)
            if not own:
                loaded = load(kind, part) if isinstance(part, str) else getattr(part, "__wrapped__", part)
                found.append(ForeignPart(package_of(loaded), title_of(kind, part)))
        except (Exception, SystemExit):  # noqa: BLE001, S112, PERF203, RUF100 - what does not load is told elsewhere
            continue
    return found


def _culprit(error: BaseException, parts: list[ForeignPart]) -> ForeignPart | None:
    """The part whose code is nearest to where an exception was raised."""
    by_package = {part.package: part for part in reversed(parts)}
    frames = [frame.f_globals.get("__name__") for frame, _ in walk_tb(error.__traceback__)]
    packages = [str(name).partition(".")[0] for name in frames]
    return next((by_package[package] for package in reversed(packages) if package in by_package), None)


def _deed(error: BaseException, culprit: ForeignPart | None) -> str:
    if isinstance(error, SystemExit):
        return f"asked to exit, with {error.code!r:.40}"
    if isinstance(error, PhframeError):
        return f"met an error: {error_text(error)}"
    return f"raised {error_text(error)}" + _place(error, culprit)


def _place(error: BaseException, culprit: ForeignPart | None) -> str:
    """The last line of the part's own code on the way to an exception."""
    summaries = extract_tb(error.__traceback__)
    names = [str(frame.f_globals.get("__name__")).partition(".")[0] for frame, _ in walk_tb(error.__traceback__)]
    lines = [each for each, name in zip(summaries, names, strict=True) if culprit and name == culprit.package]
    last = (lines or list(summaries))[-1:]
    return f" (line {last[0].lineno} of {PurePath(last[0].filename).name})" if last else ""
