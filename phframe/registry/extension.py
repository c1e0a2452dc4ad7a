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
        PluginError: If the name or the target is not of that form.
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
            raise PluginError(f"no kind of extension is called {self.kind!r}; there is: {', '.join(Kind)}")
        object.__setattr__(self, "kind", Kind(self.kind))
        if not _NAME.fullmatch(self.name):
            raise PluginError(f"{self.kind} {self.name!r}: a name is lower-case words and digits joined by '-'")
        if not _TARGET.fullmatch(self.target):
            raise PluginError(f"{self.kind} {self.name!r}: the target {self.target!r} is not 'module:Class'")
