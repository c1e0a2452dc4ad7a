"""Every exception phframe raises on purpose, under one root.

The message is built here, from the facts, so that each one says what is wrong, where, what exists instead and what to
do about it. The command line turns them into one line and an exit code.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches

_LONGEST_TEXT = 600
"""Characters of what an exception says that are shown."""


def error_text(error: BaseException) -> str:
    """What an exception of foreign code says, in one line of bounded length, whatever its class does when it is asked.

    Returns:
        The type and the text; of an error that phframe raises on purpose, the text.
    """
    try:
        kind, text = type(error).__name__, " ".join(str(error)[: 4 * _LONGEST_TEXT].split())
    except KeyboardInterrupt:
        raise
    except BaseException:  # noqa: BLE001 - its class is foreign code too
        kind, text = _kind_of(error), "it cannot say what is wrong"
    text = text if issubclass(type(error), PhframeError) else f"{kind}: {text}".removesuffix(": ")
    return text if len(text) <= _LONGEST_TEXT else f"{text[:_LONGEST_TEXT]}..."


def _kind_of(error: BaseException) -> str:
    return str(type.__dict__["__name__"].__get__(type(error)))  # a metaclass cannot change that


class PhframeError(Exception):
    """Root of all exceptions raised by phframe."""


class InputError(PhframeError):
    """Something the user gave cannot be used: a file, an option, a name, a value."""


class DocumentError(InputError):
    """A document that cannot be read, or does not say what it must.

    Args:
        problems: One sentence per thing that is wrong.
        source: The file or name of what holds it, if known.
    """

    def __init__(self, problems: str | Sequence[str], source: str | None = None) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        self.source = source
        super().__init__((f"{source}: " if source else "") + "; ".join(self.problems))

    def __reduce__(self) -> tuple[type[DocumentError], tuple[tuple[str, ...], str | None]]:
        return type(self), (self.problems, self.source)


class SceneError(DocumentError):
    """A scene that cannot be: bad fields, objects overlapping or outside the shelf, no target."""


class OptionError(InputError):
    """An option that is unknown, of the wrong type or out of range."""


class ArmError(InputError):
    """Joint values, a pose or an opening that the arm cannot have."""


_MOST_NAMES = 40
"""Shown in one message; of more the first few are, and the rest are counted."""
_FEW_NAMES = 10


class UnknownNameError(InputError):
    """A name for which nothing is registered.

    Args:
        kind: What was asked for, such as ``planner``.
        name: The name given.
        known: The names that exist.
        hint: What to do, such as an install line.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str], hint: str = "") -> None:
        self.kind, self.name, self.known, self.hint = kind, name, tuple(sorted(map(str, known))), hint
        super().__init__(self._message())

    def _message(self) -> str:
        close = get_close_matches(self.name, self.known, n=1, cutoff=0.5)
        parts = [f"no {self.kind} named {self.name!r}."]
        if close:
            parts.append(f"Did you mean {close[0]!r}?")
        parts.append(f"There is: {self._known()}." if self.known else f"There is no {self.kind} at all.")
        return " ".join([*parts, self.hint]).strip()

    def _known(self) -> str:
        if len(self.known) <= _MOST_NAMES:
            return ", ".join(self.known)
        return f"{', '.join(self.known[:_FEW_NAMES])} and {len(self.known) - _FEW_NAMES} more"

    def __reduce__(self) -> tuple[type[UnknownNameError], tuple[str, str, tuple[str, ...], str]]:
        return type(self), (self.kind, self.name, self.known, self.hint)


class NotInstalledError(PhframeError):
    """A part that needs a library which is not installed.

    Args:
        what: What was asked for, such as ``backend 'mujoco'``.
        library: The missing library.
        remedy: The line that installs it, or why that is not possible here.
    """

    def __init__(self, what: str, library: str, remedy: str) -> None:
        self.what, self.library, self.remedy = what, library, remedy
        super().__init__(f"{what} needs {library}, which is not installed. {remedy}")

    def __reduce__(self) -> tuple[type[NotInstalledError], tuple[str, str, str]]:
        return type(self), (self.what, self.library, self.remedy)


class PluginError(PhframeError):
    """A plugin that does not load or does not keep to its interface."""


class PartFailedError(PluginError):
    """A part of a run, or code that one called, raised an exception or asked to exit; its cause says where."""


class IncompatibleError(InputError):
    """Parts that exist but cannot be used together, such as an arm and a backend."""


class UnknownShapeError(PhframeError):
    """A shape that a part of phframe has no primitive for.

    Args:
        shape: The shape.
        where: What does not know it, such as ``the MuJoCo backend``.
    """

    def __init__(self, shape: object, where: str) -> None:
        self.shape, self.where = shape, where
        super().__init__(f"{where} has no primitive for the shape {getattr(shape, 'kind', type(shape).__name__)!r}")

    def __reduce__(self) -> tuple[type[UnknownShapeError], tuple[object, str]]:
        return type(self), (self.shape, self.where)


class SimulationDivergedError(PhframeError):
    """The physics engine returned poses that are not numbers or speeds that are not physical."""


class BudgetExceededError(PhframeError):
    """A planner asked for more simulated time, or more simulations, than its budget holds."""


class OverdueError(BudgetExceededError):
    """The time is over while a simulation, or what a planner does between two of them, goes on."""

    def __init__(self) -> None:
        super().__init__("the time is over: it was stopped in the middle of what it did")
