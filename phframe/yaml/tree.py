"""YAML 1.2 text as plain mappings, lists and scalars, with the line of each; anything that could surprise is refused.

Built from the parser's events without recursion. So nesting is bounded before it costs anything, aliases cannot
multiply, tags cannot construct, a key given twice is seen, and every complaint can name its line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from phframe.core import DocumentError
from phframe.yaml.scalars import plain_scalar
from phframe.yaml.wording import abridged, shortened, shown

MAX_DEPTH = 20
"""Mappings and lists inside one another; a scene, the largest of them, needs four."""

MAX_VALUES = 50_000
"""Keys, values, lists and mappings in one file; a scene of a thousand objects has about 15,000."""

Path = tuple[str | int, ...]

_HALF_CHARACTER = re.compile("[\ud800-\udfff]")


@dataclass(frozen=True, slots=True)
class YamlTree:
    """The content of one YAML document.

    Attributes:
        content: Mappings, lists and scalars; None where there is nothing.
        lines: The line (from 1) of everything in it, by the keys and positions that lead there.
    """

    content: Any
    lines: dict[Path, int]

    def line(self, path: Path) -> int:
        """The line of what is at ``path``, or of the nearest thing around it that is there."""
        while path not in self.lines and path:
            path = path[:-1]
        return self.lines.get(path, 1)


def parse_yaml(text: str, source: str) -> YamlTree:
    """Read one YAML document.

    Args:
        text: The document.
        source: The file it comes from, for the error.

    Raises:
        DocumentError: If it is not YAML, or holds aliases, anchors, tags, directives, duplicate keys, keys that are not
            plain text, more than one document, or nesting beyond ``MAX_DEPTH``.
    """
    builder = _Builder()
    try:
        for event in _events(text, source):
            builder.take(event)
    except _StopError as error:
        raise DocumentError(shortened([*builder.problems, f"line {builder.line}: {error}"]), source) from None
    if builder.problems:
        raise DocumentError(shortened(builder.problems), source)
    return YamlTree(builder.root, builder.lines)


def _events(text: str, source: str) -> Iterator[Any]:
    from ruamel.yaml import YAML

    try:
        yield from YAML(typ="safe", pure=True).parse(text)
    except Exception as error:  # the parser meets text of any kind, and whatever it raises is about that text
        raise DocumentError(_not_yaml(error, text), source) from error


def _not_yaml(error: Exception, text: str) -> str:
    mark, position = getattr(error, "problem_mark", None), getattr(error, "position", None)
    if mark is not None:
        reason = getattr(error, "problem", None) or getattr(error, "context", None) or "cannot be parsed"
        return f"line {mark.line + 1}, column {mark.column + 1}: not valid YAML: {' '.join(str(reason).split())}"
    if isinstance(position, int):
        character = ascii(text[position : position + 1])
        return f"line {text.count(chr(10), 0, position) + 1}: the character {character} is not allowed in YAML"
    return f"not valid YAML: {abridged(ascii(str(error)))}"


class _StopError(Exception):
    """What makes going on pointless: beyond a limit, or a key that is none."""


@dataclass(slots=True)
class _Level:
    path: Path
    container: dict[str, Any] | list[Any]
    key: str | None = None


@dataclass(slots=True)
class _Builder:
    """Takes events one by one; holds what has been read so far."""

    root: Any = None
    lines: dict[Path, int] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)
    levels: list[_Level] = field(default_factory=list)
    documents: int = 0
    values: int = 0
    line: int = 1

    def take(self, event: Any) -> None:
        self.line = event.start_mark.line + 1
        self.values += 1
        if self.values > MAX_VALUES:
            raise _StopError(f"more than {MAX_VALUES} values; no file that somebody wrote has as many")
        handler = _HANDLERS.get(type(event).__name__)
        if handler:
            handler(self, event)

    def start_document(self, event: Any) -> None:
        self.documents += 1
        if self.documents == 2:
            self.refuse("a second document begins; expected one per file")
        if event.version or event.tags:
            self.refuse("YAML directives (%) are not allowed")

    def scalar(self, event: Any) -> None:
        self.check_plain(event)
        if _HALF_CHARACTER.search(event.value):
            raise _StopError(f"{shown(event.value)} holds half of a character (a lone surrogate)")
        level = self.levels[-1] if self.levels else None
        if level and isinstance(level.container, dict) and level.key is None:
            self.begin_entry(level, event.value)
        else:
            self.place(plain_scalar(event.value) if event.implicit[0] else event.value)

    def start_container(self, event: Any) -> None:
        self.check_plain(event)
        if len(self.levels) >= MAX_DEPTH:
            raise _StopError(f"nested more than {MAX_DEPTH} levels deep")
        container: Any = {} if type(event).__name__ == "MappingStartEvent" else []
        self.levels.append(_Level(self.place(container), container))

    def end_container(self, _: Any) -> None:
        self.levels.pop()

    def alias(self, event: Any) -> None:
        self.refuse(f"YAML aliases (*{abridged(event.anchor)}) are not allowed; write the value out")
        self.place(None)

    def check_plain(self, event: Any) -> None:
        if event.anchor is not None:
            self.refuse(
                f"YAML anchors (&{abridged(event.anchor)}) are not allowed; write the value out where it is used"
            )
        if event.tag is not None and event.ctag:
            self.refuse(f"YAML tags ({abridged(event.tag)}) are not allowed; leave it out")

    def begin_entry(self, level: _Level, key: str) -> None:
        level.key = key
        path = (*level.path, key)
        if key in level.container:
            self.refuse(f"the key {shown(key)} is given twice (first in line {self.lines[path]})")
        self.lines[path] = self.line

    def place(self, value: Any) -> Path:
        """Put a value where the events have got to; returns the path to it."""
        if not self.levels:
            self.root = value
            return ()
        level = self.levels[-1]
        if isinstance(level.container, list):
            return self._append(level, value)
        if level.key is None:
            raise _StopError("a key is a list, mapping or alias; expected plain text")
        path = (*level.path, level.key)
        level.container[level.key], level.key = value, None
        return path

    def _append(self, level: _Level, value: Any) -> Path:
        path = (*level.path, len(level.container))
        self.lines[path] = self.line
        level.container.append(value)  # type: ignore[union-attr]
        return path

    def refuse(self, what: str) -> None:
        self.problems.append(f"line {self.line}: {what}")


_HANDLERS = {
    "DocumentStartEvent": _Builder.start_document,
    "ScalarEvent": _Builder.scalar,
    "MappingStartEvent": _Builder.start_container,
    "SequenceStartEvent": _Builder.start_container,
    "MappingEndEvent": _Builder.end_container,
    "SequenceEndEvent": _Builder.end_container,
    "AliasEvent": _Builder.alias,
}
