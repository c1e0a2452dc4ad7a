"""Which installed distributions have plugins, read from their metadata: no code of theirs runs."""

from __future__ import annotations

import re
import stat
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from phframe.core.errors import PluginError, error_text
from phframe.core.metadata_fields import fields

GROUP = "phframe"
"""The entry-point group of plugins."""
HOME = "phframe"
"""The distribution of the built-ins."""

_MOST_BYTES = {"entry_points.txt": 1 << 18, "METADATA": 1 << 23, "PKG-INFO": 1 << 23}
_SECTION = re.compile(rf"^\s*\[\s*{GROUP}\s*\]\s*$", re.MULTILINE)
_MODULE = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*(\s*:\s*[^\W\d]\w*(\.[^\W\d]\w*)*)?")
_NAME = re.compile(r"[A-Za-z0-9]([A-Za-z0-9._-]{0,98}[A-Za-z0-9])?")
_VERSION = re.compile(r"[A-Za-z0-9.!+_-]{0,100}")


@dataclass(frozen=True, slots=True)
class PluginDistribution:
    """An installed distribution that has plugins.

    Attributes:
        name: Its normalized name, such as ``phframe-lookahead``; the name of its folder, if its metadata cannot be read.
        version: Of it.
        hooks: What has the hook, each as ``module`` or ``module:object``.
        folder: Where its metadata is; None: not in a folder.
        error: Why it cannot be asked what it offers; empty: it can.
    """

    name: str
    version: str
    hooks: tuple[str, ...] = ()
    folder: Path | None = None
    error: str = ""


def with_plugins(distributions: Iterable[metadata.Distribution]) -> list[PluginDistribution]:
    """Those distributions that have plugins, by name. Of several with one name the first counts, as for imports.

    Args:
        distributions: In the order of the path.
    """
    seen: set[str] = set()
    found = []
    for each in distributions:
        stem = _stem(each)
        if stem not in seen and (plugins := _read(each)):
            found.append(plugins)
        seen.add(stem or str(id(each)))
    return sorted(found, key=lambda each: (each.name, each.version, each.hooks))


def normalized(distribution: str) -> str:
    """The one spelling of a distribution's name: ``Phframe_Look.Ahead`` is ``phframe-look-ahead``."""
    return re.sub(r"[-_.]+", "-", distribution).lower()


def _stem(distribution: metadata.Distribution) -> str:
    """The name that its folder bears; empty: there is none."""
    folder = _folder(distribution)
    return (
        normalized(folder.name.removesuffix(".dist-info").removesuffix(".egg-info").partition("-")[0]) if folder else ""
    )


def _folder(distribution: metadata.Distribution) -> Path | None:
    folder: Any = getattr(distribution, "_path", None)  # importlib.metadata does not tell it otherwise
    return folder if isinstance(folder, Path) else None


def _read(distribution: metadata.Distribution) -> PluginDistribution | None:
    folder = _folder(distribution)
    name, version = ascii(folder.name)[1:-1] if folder else "unknown", ""
    try:
        text = _text(distribution, "entry_points.txt")
        if not _SECTION.search(text):
            return None
    except Exception:  # noqa: BLE001 - whether it has plugins at all cannot be known
        return None
    try:
        name, version = _name_and_version(distribution)
        return PluginDistribution(name, version, tuple(_hooks(text)), folder)
    except Exception as error:  # noqa: BLE001 - whatever is wrong with it, the rest goes on
        return PluginDistribution(name, version, (), folder, error_text(error))


def _text(distribution: metadata.Distribution, name: str) -> str:
    """A file of the metadata; empty: there is none.

    Raises:
        PluginError: If it is no regular file, or too long to be what it should.
    """
    folder = _folder(distribution)
    if folder is None:
        return distribution.read_text(name) or ""
    try:
        status = (folder / name).stat()
    except OSError:
        return ""
    if not stat.S_ISREG(status.st_mode) or status.st_size > _MOST_BYTES[name]:
        raise PluginError(f"its {name} is no regular file of at most {_MOST_BYTES[name] >> 10} KB")
    return (folder / name).read_bytes().decode("utf-8", errors="replace")


def _name_and_version(distribution: metadata.Distribution) -> tuple[str, str]:
    found = list(fields(_text(distribution, "METADATA") or _text(distribution, "PKG-INFO")))
    first = dict(reversed(found))
    name, version = first.get("name", ""), first.get("version", "")
    if not _NAME.fullmatch(name):
        raise PluginError(f"its metadata gives it {f'the name {_short(name)}' if name else 'no name'}")
    if not _VERSION.fullmatch(version):
        raise PluginError(f"its metadata gives it the version {_short(version)}")
    if normalized(name) == HOME:
        raise PluginError(f"it bears the name of {HOME} itself")
    return normalized(name), version


def _hooks(text: str) -> Iterator[str]:
    """What the entry points of the group name, in the order of their names."""
    inside = False
    points = {}
    for line in filter(None, (line.strip() for line in text.splitlines())):
        if line.startswith(("#", ";")):
            continue
        if line.startswith("["):
            inside = bool(_SECTION.fullmatch(line))
        elif inside:
            name, equals, value = line.partition("=")
            target = value.partition("[")[0].strip()
            if not equals or not _MODULE.fullmatch(target):
                raise PluginError(f"its entry_points.txt has the line {_short(line)}, which is not 'name = module'")
            points[name.strip()] = "".join(target.split())
    yield from (points[name] for name in sorted(points))


def _short(text: str) -> str:
    return ascii(text if len(text) <= 60 else f"{text[:57]}...")
