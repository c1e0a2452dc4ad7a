"""Discovery: what phframe itself offers, and what installed distributions answer when they are asked, each on its own."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterable, Sequence
from functools import cache
from importlib import metadata

from phframe.core.distributions import HOME, PluginDistribution, normalized, with_plugins
from phframe.core.errors import InputError, PluginError
from phframe.core.version import own_version
from phframe.registry import builtin
from phframe.registry.answer import Answer
from phframe.registry.answer_cache import AnswerCache, cache_folder
from phframe.registry.catalogue import Broken, Catalogue, Entry, named
from phframe.registry.extension import Extension, Kind

ONLY = "PHFRAME_PLUGINS"
"""Environment variable: the distributions whose plugins are loaded, joined by commas; empty: none. Unset: all."""

STRICT = "PHFRAME_PLUGINS_STRICT"
"""Environment variable: 1 makes a broken plugin an error instead of leaving it out."""

SECONDS = "PHFRAME_PLUGINS_SECONDS"
"""Environment variable: how long a distribution may take to answer what it offers (s). Unset: 10."""


@cache
def builtins() -> Catalogue:
    """What phframe itself offers."""
    return Catalogue(named(_entry(each, HOME, own_version()) for each in builtin.phframe_extensions()))


@cache
def catalogue() -> Catalogue:
    """Everything that is registered in this environment; found out once per process.

    Raises:
        PluginError: If a plugin is broken and ``PHFRAME_PLUGINS_STRICT`` is 1.
        InputError: If ``PHFRAME_PLUGINS_SECONDS`` is no number of seconds.
    """
    listed = os.environ.get(ONLY)
    only = None if listed is None else [name.strip() for name in listed.split(",") if name.strip()]
    found = discover(metadata.distributions(), only)
    if found.broken and os.environ.get(STRICT) == "1":
        raise PluginError("; ".join(str(broken) for broken in found.broken))
    return found


def look_up(kind: Kind, name: str) -> Entry | None:
    """What a name, or ``distribution:name``, leads to; None: to nothing, or to more than one thing.

    No plugin is asked for what is built in.

    Raises:
        PluginError: As ``catalogue``, of a name that is not built in.
    """
    return builtins().entry(kind, name) or catalogue().entry(kind, name)


def find(kind: Kind, name: str) -> Entry:
    """As ``look_up``, of a name that must lead to something.

    Raises:
        UnknownNameError: If it leads to nothing, or to more than one thing.
        PluginError: As ``look_up``.
    """
    return builtins().entry(kind, name) or catalogue().find(kind, name)


def discover(distributions: Iterable[metadata.Distribution], only: Collection[str] | None = None) -> Catalogue:
    """Everything that is built in, and what plugins offer. None of their code runs in this process.

    Args:
        distributions: Those that may have plugins, in the order of the path.
        only: Those whose plugins are asked; None: all.
    """
    wanted = None if only is None else {normalized(name) for name in only}
    found = [] if wanted == set() else with_plugins(distributions)
    asked = [each for each in found if wanted is None or each.name in wanted]
    broken = [
        Broken(name, "", "no such plugin is installed") for name in sorted((wanted or set()) - {x.name for x in asked})
    ]
    entries = list(builtins().entries)
    for each, answer in zip(asked, _answers(asked), strict=True):
        entries += [_entry(extension, each.name, each.version) for extension in answer.extensions]
        if answer.error:
            broken.append(Broken(each.name, each.version, answer.error))
    return Catalogue(named(entries), tuple(broken))


def _answers(asked: Sequence[PluginDistribution]) -> list[Answer]:
    """What each answers; only those whose answer is not kept are asked."""
    kept = AnswerCache(cache_folder())
    known = {number: Answer(error=each.error) for number, each in enumerate(asked) if each.error}
    known |= {n: found for n, each in enumerate(asked) if n not in known and (found := kept.get(each))}
    rest = [number for number in range(len(asked)) if number not in known]
    if rest:
        from phframe.registry.asking import ask_all  # seldom needed

        since = time.time_ns()
        known |= dict(zip(rest, ask_all([asked[number] for number in rest], _seconds()), strict=True))
        for number in rest:
            kept.put(asked[number], known[number], since)
    return [known[number] for number in range(len(asked))]


def _seconds() -> float:
    given = os.environ.get(SECONDS, "10")
    try:
        seconds = float(given)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds < 1e6:
        raise InputError(f"{SECONDS} is a number of seconds above 0, not {given!r}")
    return seconds


def _entry(extension: Extension, distribution: str, version: str) -> Entry:
    return Entry(extension, distribution, version, extension.name)
