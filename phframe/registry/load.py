"""From a name, or a file, to the class."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any

from phframe.core.arm import ArmModel
from phframe.core.errors import NotInstalledError, PluginError
from phframe.core.goal import Goal
from phframe.core.physics import Physics
from phframe.core.planner import Planner
from phframe.core.suite import SceneSuite
from phframe.core.topology import TopologyEngine
from phframe.registry.catalogue import Catalogue, Entry
from phframe.registry.extension import Kind
from phframe.registry.from_file import is_file, load_from_file
from phframe.registry.manager import catalogue
from phframe.registry.requirements import missing

INTERFACES: Mapping[Kind, type] = MappingProxyType(
    {
        Kind.PLANNER: Planner,
        Kind.BACKEND: Physics,
        Kind.ARM: ArmModel,
        Kind.TOPOLOGY: TopologyEngine,
        Kind.SCENES: SceneSuite,
        Kind.GOAL: Goal,
    }
)
"""What the classes of each kind are subclasses of; kinds that are not here have no interface."""


def load(kind: Kind, spec: str, registered: Catalogue | None = None) -> Any:
    """The class that a spec stands for. A spec is all that another process needs to load it too.

    Args:
        kind: What it is.
        spec: A name, ``distribution:name``, or a file and a class in it, ``./mine.py:Mine``.
        registered: Where names are looked up; None: all that is registered in this environment.

    Raises:
        UnknownNameError: If there is no such name.
        NotInstalledError: If it needs a library that is not installed.
        PluginError: If it does not load or does not keep to its interface.
        InputError: If a file cannot be read.
    """
    if is_file(spec):
        return _checked(kind, spec, load_from_file(spec, INTERFACES.get(kind, object)))
    entry = (registered or catalogue()).find(kind, spec)
    return _checked(kind, entry.name, _import(entry))


def create(kind: Kind, spec: str, options: Mapping[str, Any] | None = None, registered: Catalogue | None = None) -> Any:
    """An object of the class that a spec stands for, of a kind that is made from options alone: all but backends.

    Args:
        kind: Planner, arm, topology or scenes.
        spec: As for ``load``.
        options: Values, or their text, by name.
        registered: As for ``load``.

    Raises:
        OptionError: If an option is unknown, of the wrong type or out of range.
        PhframeError: As ``load``.
    """
    loaded = load(kind, spec, registered)
    return loaded(loaded.options_type.parse(options or {}, f"{kind} {spec}"))


def _import(entry: Entry) -> Any:
    module, _, name = entry.extension.target.partition(":")
    what = f"{entry.extension.kind} {entry.name!r}"
    try:
        return getattr(import_module(module), name)
    except (Exception, SystemExit) as error:
        gap = missing(entry.distribution, entry.extension.extra) if _is_foreign(error, module) else None
        if gap:
            raise NotInstalledError(what, gap.library, gap.remedy) from error
        origin = f"{entry.distribution} {entry.version}".strip()
        raise PluginError(f"{what} of {origin} does not load: {type(error).__name__}: {error}") from error


def _is_foreign(error: BaseException, module: str) -> bool:
    """Whether a module is missing that is not the extension's own."""
    own = module.partition(".")[0]
    return isinstance(error, ModuleNotFoundError) and (error.name or own).partition(".")[0] != own


def _checked(kind: Kind, spec: str, loaded: Any) -> Any:
    interface = INTERFACES.get(kind)
    if interface is None:
        return loaded
    if not (isinstance(loaded, type) and issubclass(loaded, interface)):
        raise PluginError(f"{kind} {spec!r} is not a subclass of phframe.core.{interface.__name__}")
    if absent := sorted(getattr(loaded, "__abstractmethods__", ())):
        raise PluginError(f"{kind} {spec!r} does not implement: {', '.join(absent)}")
    return loaded
