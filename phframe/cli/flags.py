"""The flags of the commands in short: what those of one kind have in common, and those that several commands share."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

from phframe.cli import completion


def literal(text: str) -> str:
    """A help text or an example in which brackets are brackets: what prints the help takes them for markup."""
    return text.replace("[", "\\[")


def plain(text: str) -> str:
    """The text that ``literal`` was given."""
    return text.replace("\\[", "[")


def flag(metavar: str, meaning: str, default: str | bool = True, **more: Any) -> Any:
    """A flag that takes a value, called like the parameter of the command.

    Args:
        metavar: What its value is called.
        meaning: Its help.
        default: What the help says it is by default; True: the value that the command has for it.
        more: For ``typer.Option``.
    """
    return typer.Option(metavar=metavar, help=literal(meaning), show_default=default, **more)


def part(kind: str, meaning: str, default: str | bool = True) -> Any:
    """The flag of an exchangeable part of a kind, whose registered names the shell offers; otherwise as ``flag``."""
    return flag("NAME", meaning, default, autocompletion=completion.names(kind))


def path(text: str | Path) -> Path:
    """The parser of a flag that names a file or directory. A leading ``~`` is expanded, also in ``--out=~/x``.

    Raises:
        InputError: If it cannot be a path.
    """
    from phframe.core.paths import user_path  # heavy, and seldom needed

    return user_path(text)


def finite(value: Any) -> Any:
    """The callback of a flag of one or more numbers, which must be finite; None: it is not given.

    Raises:
        BadParameter: If one is infinite or not a number.
    """
    for figure in value if isinstance(value, tuple) else (value,):
        if figure is not None and not math.isfinite(figure):
            raise typer.BadParameter(f"{figure} is not a finite number.")
    return value


Arm = Annotated[str, part("arm", "The robot arm: a name ('phframe arms') or ./mine.py:Mine.")]
