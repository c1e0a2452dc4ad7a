"""What a check is: a named promise, and the ways in which an implementation was found to break it."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from phframe.core import PhframeError

SubjectT = TypeVar("SubjectT")


@dataclass(frozen=True, slots=True)
class Fault:
    """One way in which a promise is broken.

    Attributes:
        expected: What should have come.
        found: What came instead.
    """

    expected: str
    found: str


Faults = Iterator[Fault]


@dataclass(frozen=True, slots=True)
class Failure:
    """A check that found faults.

    Attributes:
        check: Name of the check.
        contract: What the interface promises.
        faults: What was expected and found.
    """

    check: str
    contract: str
    faults: tuple[Fault, ...]

    def __str__(self) -> str:
        lines = [f"- {self.check}", f"    the contract: {self.contract}"]
        for fault in self.faults:
            lines += [f"    expected: {fault.expected}", f"    found:    {fault.found}"]
        return "\n".join(lines)


class ConformanceError(PhframeError, AssertionError):
    """An implementation that does not keep to its interface.

    Args:
        subject: Which implementation.
        failures: Every check that found faults.
    """

    def __init__(self, subject: str, failures: Sequence[Failure]) -> None:
        self.subject, self.failures = subject, tuple(failures)
        super().__init__("\n".join([f"{subject} does not keep to its interface:", *map(str, self.failures)]))

    def __reduce__(self) -> tuple[type[ConformanceError], tuple[str, tuple[Failure, ...]]]:
        return type(self), (self.subject, self.failures)


class NotApplicableError(PhframeError):
    """A check of something that an implementation is free not to offer; the message says what."""


@dataclass(frozen=True, slots=True)
class Check(Generic[SubjectT]):
    """A check that can be run on its own: call it with a subject.

    Attributes:
        name: What it makes sure of.
        contract: What the interface promises.
        body: Yields the faults it finds.
    """

    name: str
    contract: str
    body: Callable[[SubjectT], Iterable[Fault]]

    def __call__(self, subject: SubjectT) -> None:
        """Run the check.

        Raises:
            ConformanceError: If it finds faults.
            NotApplicableError: If it is about something that the subject does not offer.
        """
        failure = self.failure(subject)
        if failure is not None:
            raise ConformanceError(str(subject), [failure])

    def failure(self, subject: SubjectT) -> Failure | None:
        """What the check finds, or None. An exception that gets out of the implementation is a fault too.

        Raises:
            NotApplicableError: If it is about something that the subject does not offer.
        """
        faults: list[Fault] = []
        try:
            faults.extend(self.body(subject))
        except NotApplicableError:
            raise
        except Exception as error:  # noqa: BLE001 - whatever an implementation raises is a finding
            faults.append(Fault("no exception", _in_a_line(error)))
        return Failure(self.name, self.contract, tuple(faults)) if faults else None


def check(body: Callable[[SubjectT], Iterable[Fault]]) -> Check[SubjectT]:
    """Makes a check of a function: its name is the check's, its docstring what the contract says."""
    return Check(body.__name__, " ".join((body.__doc__ or "").split()), body)


@dataclass(frozen=True, slots=True)
class Report:
    """All checks passed.

    Attributes:
        passed: Their names.
        not_applicable: Names of those about something that is not offered, with the reason.
    """

    passed: tuple[str, ...]
    not_applicable: tuple[tuple[str, str], ...] = ()


def run_checks(subject: SubjectT, checks: Iterable[Check[SubjectT]]) -> Report:
    """Run all checks, the failed ones included, to the last.

    Raises:
        ConformanceError: If any finds faults; it lists all of them.
    """
    passed: list[str] = []
    skipped: list[tuple[str, str]] = []
    failures: list[Failure] = []
    for each in checks:
        try:
            failure = each.failure(subject)
        except NotApplicableError as reason:
            skipped.append((each.name, str(reason)))
            continue
        if failure is None:
            passed.append(each.name)
        else:
            failures.append(failure)
    if failures:
        raise ConformanceError(str(subject), failures)
    return Report(tuple(passed), tuple(skipped))


def _in_a_line(error: Exception) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}: {' '.join(str(error).split())}{where}"
