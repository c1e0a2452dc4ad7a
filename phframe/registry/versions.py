"""Versions of what takes part in a run, from the metadata of the distributions that it comes from."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Iterator
from functools import cache

from phframe.core.distributions import HOME
from phframe.core.metadata_fields import UNREADABLE, version_of
from phframe.registry.catalogue import Catalogue
from phframe.registry.extension import Kind
from phframe.registry.manager import look_up
from phframe.registry.requirements import required


def versions(used: Iterable[tuple[Kind, str]], registered: Catalogue | None = None) -> dict[str, str]:
    """Versions of Python, of phframe, of the plugins used, of the libraries that they ask for, and of what those use.

    Of a distribution that is what it needs itself; of an extra, also what its libraries need: ``coal`` comes with ``pin``.

    Args:
        used: Kinds and names of extensions; what is not registered has no version.
        registered: Where names are looked up; None: all that is registered in this environment.
    """
    found: dict[str, None] = dict.fromkeys([HOME, *required(HOME)])
    for kind, name in used:
        if (entry := registered.entry(kind, name) if registered else look_up(kind, name)) is None:
            continue
        extension = entry.extension
        extras = [extra for extra in (extension.extra, *extension.uses) if extra]
        found |= dict.fromkeys([entry.distribution, *required(entry.distribution)])
        found |= dict.fromkeys(_of_extras(entry.distribution, extras))
    installed = ((name, version) for name in found if (version := _version(name)))
    return {"python": platform.python_version(), **dict(installed)}


def _of_extras(distribution: str, extras: Iterable[str]) -> Iterator[str]:
    for library in (name for extra in extras for name in required(distribution, extra)):
        yield library
        yield from required(library)


@cache
def _version(distribution: str) -> str:
    try:
        return version_of(distribution)
    except UNREADABLE:
        return "unknown" if distribution == HOME else ""
