"""Names: what people, files and terminals must be able to show on one line."""

from __future__ import annotations

LONGEST_NAME = 100
"""Characters."""


def name_fault(name: str) -> str:
    """What keeps a text from being a name, in words; empty: nothing does."""
    if not name:
        return "is empty"
    if len(name) > LONGEST_NAME:
        return f"has {len(name)} characters; at most {LONGEST_NAME} are allowed"
    if not name.isprintable() or name != name.strip():
        return "must be printable text on one line, without spaces at its ends"
    return ""


def name_shown(name: str) -> str:
    """A text that should be a name, in a message: quoted, printable and short."""
    text = repr(name) if name.isprintable() else ascii(name)
    return text if len(text) <= LONGEST_NAME else f"{text[: LONGEST_NAME // 2]}...'"
