"""What a distribution answers when it is asked what it offers: as JSON, which is checked like any foreign file."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from phframe.core.errors import PluginError, error_text
from phframe.registry.extension import API_VERSION, Extension

MOST_EXTENSIONS = 1000
"""That one distribution may offer."""
MOST_NAMES = 10_000
"""Of scenes that a suite may list."""
_LONGEST_NAME = 200
MOST_BYTES = 4 << 20
"""Of an answer."""
UNREADABLE = (ValueError, TypeError, KeyError, AttributeError, RecursionError)
"""What reading a text that is no answer raises."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What a distribution offers, or why that is not known.

    Attributes:
        extensions: What it offers.
        names: Of scenes, where it was asked for those of a suite.
        error: What is wrong with it, in a line; empty: nothing.
        files: The files whose code was run to find out.
        hasty: Whether the reason may be gone at the next attempt, because it is the time that it took.
    """

    extensions: tuple[Extension, ...] = ()
    error: str = ""
    files: tuple[str, ...] = ()
    hasty: bool = False
    names: tuple[str, ...] = ()


def to_json(answer: Answer) -> str:
    """The answer as a line of JSON."""
    return json.dumps(asdict(answer))


def from_json(text: str | bytes) -> Answer:
    """An answer that somebody wrote. One that breaks the rules becomes the reason why it is not taken."""
    try:
        return read(text)
    except PluginError as error:
        return Answer(error=str(error))
    except UNREADABLE as error:
        return Answer(error=f"its answer cannot be read: {error_text(error)}")


def read(text: str | bytes) -> Answer:
    """An answer that was written by ``to_json``.

    Raises:
        PluginError: If it breaks the rules.
        UNREADABLE: If it is no answer.
    """
    if len(text) > MOST_BYTES:
        raise PluginError(f"its answer is longer than {MOST_BYTES >> 10} KB")
    given = json.loads(text)
    files = tuple(str(each) for each in given["files"])
    if given["error"]:
        return Answer((), str(given["error"]), files, bool(given["hasty"]))
    offered = _accepted([_extension(each) for each in given["extensions"]])
    return Answer(offered, "", files, names=tuple(_name(each) for each in given["names"]))


def _extension(given: Mapping[str, Any]) -> Extension:
    tuples = {"uses": tuple(given["uses"]), "variants": tuple((key, text) for key, text in given["variants"])}
    return Extension(**{**given, **tuples})


def _name(text: Any) -> str:
    if not (isinstance(text, str) and text.isprintable() and len(text) <= _LONGEST_NAME):
        raise PluginError(f"it has a scene whose name is no line of at most {_LONGEST_NAME} printable characters")
    return text


def _accepted(extensions: list[Extension]) -> tuple[Extension, ...]:
    if len(extensions) > MOST_EXTENSIONS:
        raise PluginError(f"it offers {len(extensions)} extensions; one distribution may offer {MOST_EXTENSIONS}")
    for extension in extensions:
        if extension.api_version != API_VERSION:
            raise PluginError(_other_version(extension))
    counts = Counter(f"{extension.kind} {extension.name!r}" for extension in extensions)
    if twice := sorted(name for name, count in counts.items() if count > 1):
        raise PluginError(f"it offers two of the same name: {', '.join(twice[:10])}")
    return tuple(extensions)


def _other_version(extension: Extension) -> str:
    """What to do about an extension for another version of the interfaces."""
    remedy = (
        "upgrade phframe"
        if extension.api_version > API_VERSION
        else f"docs/migration.md says what to change in it, and that its api_version is then {API_VERSION}"
    )
    return (
        f"{extension.kind} {extension.name!r} is for version {extension.api_version} of phframe's interfaces;"
        f" this phframe has version {API_VERSION}: {remedy}"
    )
