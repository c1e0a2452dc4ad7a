"""Everything that is registered, and which name leads to what."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace

from phframe.core.distributions import HOME, normalized
from phframe.core.errors import UnknownNameError
from phframe.registry.extension import Extension, Kind
from phframe.registry.requirements import missing


@dataclass(frozen=True, slots=True)
class Entry:
    """A registered extension.

    Attributes:
        extension: The extension.
        distribution: The distribution it comes from, such as ``phframe-lookahead``.
        version: Of the distribution.
        name: What it is asked for by: its own name, or ``distribution:name`` where its own leads to another or to none.
    """

    extension: Extension
    distribution: str
    version: str
    name: str

    @property
    def qualified_name(self) -> str:
        """``distribution:name``, by which it can always be asked for."""
        return f"{self.distribution}:{self.extension.name}"


@dataclass(frozen=True, slots=True)
class Broken:
    """A plugin that was left out.

    Attributes:
        distribution: The distribution it comes from.
        version: Of the distribution; empty if it is not installed.
        error: What is wrong, in a line.
    """

    distribution: str
    version: str
    error: str

    def __str__(self) -> str:
        return f"plugin {f'{self.distribution} {self.version}'.strip()} is not loaded: {self.error}"


@dataclass(frozen=True, slots=True)
class Catalogue:
    """Everything that is registered.

    A plain name leads to the built-in if there is one, else to the only plugin that offers it. Where several plugins
    offer it, it leads to none of them, so that installing another plugin never changes what a name means unnoticed.

    Attributes:
        entries: All that can be asked for, the built-ins first.
        broken: The plugins that were left out.
    """

    entries: tuple[Entry, ...]
    broken: tuple[Broken, ...] = ()

    def extensions(self, kind: Kind) -> tuple[Entry, ...]:
        """All of one kind, the built-ins first."""
        return tuple(entry for entry in self.entries if entry.extension.kind is kind)

    def entry(self, kind: Kind, name: str) -> Entry | None:
        """What a name, or ``distribution:name``, leads to; None: to nothing, or to more than one thing."""
        distribution, colon, own_name = name.rpartition(":")
        wanted = f"{normalized(distribution)}:{own_name}" if colon else name
        return next((each for each in self.extensions(kind) if wanted in (each.name, each.qualified_name)), None)

    def find(self, kind: Kind, name: str) -> Entry:
        """What a name, or ``distribution:name``, leads to.

        Raises:
            UnknownNameError: If it leads to nothing, or to more than one thing.
        """
        if entry := self.entry(kind, name):
            return entry
        raise UnknownNameError(kind, name, [entry.name for entry in self.extensions(kind)], self._hint(kind, name))

    def _hint(self, kind: Kind, name: str) -> str:
        rivals = [entry.name for entry in self.extensions(kind) if entry.extension.name == name]
        ambiguous = [f"More than one plugin offers it: say which, {' or '.join(rivals)}."] if rivals else []
        needs = {entry.name: (entry.distribution, entry.extension.extra) for entry in self.extensions(kind)}
        gaps = {each: missing(*each) for each in dict.fromkeys(needs.values())}  # reading what they need takes its time
        lacking = [f"{name!r} cannot be used yet: {gap.remedy}." for name, each in needs.items() if (gap := gaps[each])]
        return " ".join([*ambiguous, *lacking, *(f"({broken})" for broken in self.broken)])


def named(entries: Iterable[Entry]) -> tuple[Entry, ...]:
    """The entries with the names that they are asked for by, settling clashes."""
    entries = tuple(entries)
    offered = Counter((entry.extension.kind, entry.extension.name) for entry in entries)

    def name(entry: Entry) -> str:
        only = offered[entry.extension.kind, entry.extension.name] == 1
        return entry.extension.name if only or entry.distribution == HOME else entry.qualified_name

    return tuple(replace(entry, name=name(entry)) for entry in entries)
