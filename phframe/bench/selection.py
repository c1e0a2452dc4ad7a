"""From what is asked for, such as ``vieira``, ``papallas/s0*`` or ``random/0..99``, to the problems of suites."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

from phframe.core import InputError, Scene, SceneSuite, UnknownNameError
from phframe.registry import Kind, catalogue, create, look_up
from phframe.runtime.scenes import find_scene
from phframe.scenes.spec import is_file_spec

FILES = "files"
"""The suite of the scenes that are files."""
_RANGE = re.compile(r"(.*?)(\d+)\.\.(\d+)")
_MOST, _DIGITS = 1_000_000, 18
"""Problems of a range, and digits of their numbers."""


@dataclass(frozen=True, slots=True)
class Problem:
    """A scene of a bench.

    Attributes:
        suite: The suite it belongs to.
        name: ``suite/name``, or a scene file.
        scene: The scene.
    """

    suite: str
    name: str
    scene: Scene


def select_problems(asked: Sequence[str], options: Mapping[str, Any]) -> tuple[Problem, ...]:
    """The problems that are meant, each once, in the order asked for.

    Args:
        asked: Suites (of a generator, its examples), ``suite/name`` with wildcards or a range of numbers, scene files.
        options: Of the suites, by key.

    Raises:
        InputError: If there is no such suite or scene, a wildcard matches none, or a scene cannot be.
    """
    names = dict.fromkeys(pair for text in asked for pair in _names(text, options))
    return tuple(Problem(suite, name, find_scene(name, None if suite == FILES else options)) for suite, name in names)


def _names(text: str, options: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Suite and name of each problem that a text means."""
    if is_file_spec(text):
        yield FILES, text
        return
    suite, slash, pattern = text.partition("/")
    for name in _matching(suite, pattern, options) if slash else _suite(suite, options).names():
        yield suite, f"{suite}/{name}"


def _suite(name: str, options: Mapping[str, Any]) -> SceneSuite[Any]:
    if ":" not in name and look_up(Kind.SCENES, name) is None:
        known = [entry.name for entry in catalogue().extensions(Kind.SCENES)]
        raise UnknownNameError("suite of scenes", name, known, "A scene file ends in .yaml.")
    suite: SceneSuite[Any] = create(Kind.SCENES, name, options)
    return suite


def _matching(suite: str, pattern: str, options: Mapping[str, Any]) -> Sequence[str]:
    if whole := _RANGE.fullmatch(pattern):
        return _numbered(*whole.groups())
    if not set(pattern) & set("*?["):
        return [pattern]
    known = _suite(suite, options).names()
    if not (found := [name for name in known if fnmatchcase(name, pattern)]):
        raise UnknownNameError("scene", f"{suite}/{pattern}", [f"{suite}/{name}" for name in known])
    return found


def _numbered(before: str, first: str, last: str) -> Sequence[str]:
    """The names of a range, with as many leading zeros as its first has."""
    width = len(first) if first.startswith("0") else 1
    short = max(len(first), len(last)) <= _DIGITS
    if not (short and 0 <= int(last) - int(first) < _MOST):
        told = "..".join(
            each if len(each) <= _DIGITS else f"{each[:_DIGITS]}(and more digits)" for each in (first, last)
        )
        raise InputError(f"the range {told} holds no scene or too many: write it as in random/0..99")
    return [f"{before}{number:0{width}}" for number in range(int(first), int(last) + 1)]
