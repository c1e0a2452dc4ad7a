"""What a plugin offers, by name: nothing is imported until somebody asks for it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

from phframe.core.errors import PluginError

API_VERSION = 2
"""Version of the interfaces that plugins are written against."""
FIRST_API_VERSION = 1

_NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
_LONGEST = 300
"""Characters of a text."""
_TARGET = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*")


class Kind(StrEnum):
    """What an extension is."""

    PLANNER = "planner"
    BACKEND = "backend"
    ARM = "arm"
    TOPOLOGY = "topology"
    SCENES = "scenes"
    GOAL = "goal"
    RECORDER = "recorder"
    COMMAND = "command"


@dataclass(frozen=True, slots=True)
class Extension:
    """One thing that a plugin, or phframe itself, adds.

    Attributes:
        kind: What it is.
        name: What people call it: lower-case words and digits, joined by ``-``.
        target: Where it is, as ``module:Class``. It is imported only when it is used.
        summary: One line for the listings.
        extra: The extra of its distribution that brings the libraries it needs, such as ``mujoco``; None: none.
        api_version: The ``API_VERSION`` it was written for; where it is not said, the first, which did not ask for it.
        uses: Further extras that it uses where they are installed, and whose versions belong to what it does.
        variants: Options with which it is listed as a thing of its own, such as ``sweeps=paper``, each with its summary.

    Raises:
        PluginError: If one is not of that form, or too long.
    """

    kind: Kind
    name: str
    target: str
    summary: str
    extra: str | None = None
    api_version: int = FIRST_API_VERSION
    uses: tuple[str, ...] = ()
    variants: tuple[tuple[str, str], ...] = ()

    def __post_init__(self) -> None:
        if self.kind not in list(Kind):
            raise PluginError(f"no kind of extension is called {_short(self.kind)}; there is: {', '.join(Kind)}")
        object.__setattr__(self, "kind", Kind(self.kind))
        if not (_is_line(self.name) and _NAME.fullmatch(self.name)):
            raise PluginError(f"{self.kind} {_short(self.name)}: a name is lower-case words and digits joined by '-'")
        if not (_is_line(self.target) and _TARGET.fullmatch(self.target)):
            raise PluginError(f"{self.kind} {self.name!r}: the target {_short(self.target)} is not 'module:Class'")
        if type(self.api_version) is not int:
            raise PluginError(
                f"{self.kind} {self.name!r}: the api_version {_short(self.api_version)} is no whole number"
            )
        for text in self._texts():
            if not _is_line(text):
                raise PluginError(
                    f"{self.kind} {self.name!r}: {_short(text)} is no line of at most {_LONGEST} printable characters"
                )

    def _texts(self) -> tuple[object, ...]:
        """All that is told of it as it stands."""
        try:
            variants = [text for pair in self.variants for text in pair]
            return (self.summary, *(() if self.extra is None else (self.extra,)), *self.uses, *variants)
        except TypeError:
            raise PluginError(
                f"{self.kind} {self.name!r}: 'uses' is a tuple of names, 'variants' one of options and summaries"
            ) from None


def _is_line(text: object) -> bool:
    return isinstance(text, str) and text.isprintable() and len(text) <= _LONGEST


def _short(value: object) -> str:
    text = ascii(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
