"""Discovery: asks phframe itself and every installed plugin, each on its own, what they offer."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from importlib import metadata
from importlib.metadata import EntryPoint

import pluggy

from phframe.core.errors import PluginError
from phframe.core.version import own_version
from phframe.registry import builtin, hookspec
from phframe.registry.catalogue import HOME, Broken, Catalogue, Entry, named, normalized
from phframe.registry.extension import API_VERSION, Extension

ONLY = "PHFRAME_PLUGINS"
"""Environment variable: the distributions whose plugins are loaded, joined by commas; empty: none. Unset: all."""

STRICT = "PHFRAME_PLUGINS_STRICT"
"""Environment variable: 1 makes a broken plugin an error instead of leaving it out."""


@cache
def catalogue() -> Catalogue:
    """Everything that is registered in this environment; found out once per process.

    Raises:
        PluginError: If a plugin is broken and ``PHFRAME_PLUGINS_STRICT`` is 1.
    """
    listed = os.environ.get(ONLY)
    only = None if listed is None else [name.strip() for name in listed.split(",") if name.strip()]
    found = discover(metadata.entry_points(group=hookspec.PROJECT), only)
    if found.broken and os.environ.get(STRICT) == "1":
        raise PluginError("; ".join(str(broken) for broken in found.broken))
    return found


def discover(entry_points: Iterable[EntryPoint], only: Collection[str] | None = None) -> Catalogue:
    """Everything that is built in, and what plugins offer. Nothing they offer is imported.

    Args:
        entry_points: The plugins, each an object with the hook.
        only: The distributions whose plugins are loaded; None: all.
    """
    wanted = None if only is None else {normalized(name) for name in only}
    plugins: dict[tuple[str, str], list[EntryPoint]] = {}
    for point in sorted(entry_points, key=lambda point: (_origin(point), point.name)):
        if wanted is None or _origin(point)[0] in wanted:
            plugins.setdefault(_origin(point), []).append(point)
    entries = [_entry(extension, HOME, own_version()) for extension in _ask(builtin)]
    broken = [Broken(name, "", "no such plugin is installed") for name in sorted((wanted or set()) - _names(plugins))]
    for (distribution, version), points in plugins.items():
        try:
            entries += [_entry(extension, distribution, version) for extension in _offered(points)]
        except (Exception, SystemExit) as error:  # noqa: BLE001 - whatever a plugin does, the rest goes on
            broken.append(Broken(distribution, version, _in_a_line(error)))
    return Catalogue(named(entries), tuple(broken))


def _offered(points: Iterable[EntryPoint]) -> list[Extension]:
    """All that the plugins of one distribution offer."""
    extensions = [extension for point in points for extension in _ask(point.load())]
    names = [f"{extension.kind} {extension.name!r}" for extension in extensions]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise PluginError(f"it offers two of the same name: {', '.join(twice)}")
    return extensions


def _ask(plugin: object) -> list[Extension]:
    """What one plugin offers. It has a pluggy manager of its own: in a shared one, one error would silence all."""
    manager = pluggy.PluginManager(hookspec.PROJECT)
    manager.add_hookspecs(hookspec)
    manager.register(plugin)
    manager.check_pending()
    if not manager.hook.phframe_extensions.get_hookimpls():
        raise PluginError("it has no function phframe_extensions() marked with @hookimpl")
    answers = manager.hook.phframe_extensions()
    return list(_checked(answers[0] if answers else None))


def _checked(answer: object) -> Iterator[Extension]:
    if not isinstance(answer, list):
        raise PluginError(f"phframe_extensions() returned a {type(answer).__name__}, not a list of Extension")
    for extension in answer:
        if not isinstance(extension, Extension):
            raise PluginError(f"phframe_extensions() returned {extension!r} among its extensions")
        if extension.api_version != API_VERSION:
            raise PluginError(_other_version(extension))
        yield extension


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


def _entry(extension: Extension, distribution: str, version: str) -> Entry:
    return Entry(extension, distribution, version, extension.name)


def _names(plugins: Iterable[tuple[str, str]]) -> set[str]:
    return {distribution for distribution, _ in plugins}


def _origin(point: EntryPoint) -> tuple[str, str]:
    """Name and version of the distribution that an entry point comes from."""
    return (normalized(point.dist.name), point.dist.version) if point.dist else ("unknown", "")


def _in_a_line(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return text if isinstance(error, PluginError) else f"{type(error).__name__}: {text}".removesuffix(": ")
