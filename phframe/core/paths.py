"""Paths as users write them."""

from __future__ import annotations

from pathlib import Path

from phframe.core.errors import InputError


def user_path(text: str | Path) -> Path:
    """The path that a text stands for, a leading ``~`` expanded.

    Raises:
        InputError: If it cannot be a path.
    """
    try:
        if "\0" in str(text):
            raise ValueError("it holds a zero byte")
        return Path(text).expanduser()
    except (OSError, RuntimeError, ValueError) as error:
        raise InputError(f"{str(text)!r} is not a path: {error}") from None
