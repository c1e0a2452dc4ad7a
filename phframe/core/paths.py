"""Paths as users write them."""

from __future__ import annotations

import os
from pathlib import Path

from phframe.core.errors import InputError


def user_path(text: str | Path) -> Path:
    """The path that a text stands for, a leading ``~`` expanded: of every flag and argument that names a file.

    Raises:
        InputError: If it cannot be a path.
    """
    try:
        if not str(text):
            raise ValueError("it is empty")
        if b"\0" in os.fsencode(text):
            raise ValueError("it holds a zero byte")
        return Path(text).expanduser()
    except (OSError, RuntimeError, ValueError) as error:
        why = "it holds a character that no file's name can" if isinstance(error, UnicodeError) else error
        raise InputError(f"{str(text)!r} is not a path: {why}") from None


def path_shown(path: str | Path) -> str:
    """A path in a message: on one line whatever it holds."""
    text = str(path)
    return text if text.isprintable() else ascii(text)
