"""How values and places in a scene file are shown in messages: short, on one line, printable."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Any

MOST_SHOWN = 10
"""Problems named in one message; the rest are counted."""

_LONGEST = 40


def shown(value: Any) -> str:
    """A value as a reader of the file would call it."""
    if value is None:
        return "empty"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict | list):
        return "a mapping" if isinstance(value, dict) else f"a list of {len(value)}"
    return abridged(ascii(value) if isinstance(value, str) and not value.isprintable() else repr(value))


def abridged(text: str) -> str:
    """A text, cut where it is too long for a message."""
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def place(path: Sequence[str | int]) -> str:
    """A path such as ``objects[3].radius``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += ("." if text else "") + (part if part.isidentifier() else shown(part))
    return text or "the file"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`` (did you mean 'radius'?)``, or nothing where no known name is near."""
    close = get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f" (did you mean {close[0]!r}?)" if close else ""


def shortened(problems: Iterable[str]) -> list[str]:
    """The first problems, and how many more there are."""
    every = list(problems)
    more = len(every) - MOST_SHOWN
    return [*every[:MOST_SHOWN], f"and {more} more"] if more > 0 else every
