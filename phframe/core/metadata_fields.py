"""The fields of a distribution's metadata, without the description after them: with it, reading takes ten times as long."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import metadata

UNREADABLE = (metadata.PackageNotFoundError, OSError, ValueError)
"""Raised where a distribution is not installed, or its metadata cannot be read or is no text."""


def fields(text: str) -> Iterator[tuple[str, str]]:
    """The names of the fields, in lower case, and the first lines of their values.

    Args:
        text: Of a file ``METADATA`` or ``PKG-INFO``.
    """
    for line in text.split("\n"):
        if not line.rstrip("\r"):
            return  # what follows is the description
        if line[0].isspace():  # more of the field before, such as a licence
            continue
        name, _, value = line.partition(":")
        yield name.strip().lower(), value.strip()


def version_of(distribution: str) -> str:
    """The version of an installed distribution; empty: it gives none.

    Raises:
        UNREADABLE: One of these, if it cannot be found out.
    """
    found = metadata.distribution(distribution)
    text = found.read_text("METADATA") or found.read_text("PKG-INFO") or ""
    return next((value for name, value in fields(text) if name == "version"), "")


def requirements_of(distribution: str) -> list[str]:
    """What an installed distribution asks for, line by line.

    Raises:
        UNREADABLE: One of these, if it cannot be found out.
    """
    found = metadata.distribution(distribution)
    if text := found.read_text("METADATA"):
        return [value for name, value in fields(text) if name == "requires-dist"]
    return list(found.requires or ())  # of an egg: they are in a file of their own
