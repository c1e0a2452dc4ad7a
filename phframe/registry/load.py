"""From a name, or a file, to the class; and from a class to its name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any

from phframe import core
from phframe.core.distributions import HOME
from phframe.core.errors import InputError, NotInstalledError, OptionError, PluginError
from phframe.core.stored_name import StoredName
from phframe.core.variant import merged_options, split_variant
from phframe.registry.catalogue import Catalogue, Entry
from phframe.registry.extension import Kind
from phframe.registry.foreign import foreign_code
from phframe.registry.from_file import is_file, load_from_file
from phframe.registry.manager import builtins, catalogue, find
from phframe.registry.requirements import missing

INTERFACES: Mapping[Kind, str] = MappingProxyType(
    {
        Kind.PLANNER: "Planner",
        Kind.BACKEND: "Physics",
        Kind.ARM: "ArmModel",
        Kind.TOPOLOGY: "TopologyEngine",
        Kind.SCENES: "SceneSuite",
        Kind.GOAL: "Goal",
    }
)
"""What, of ``phframe.core``, the classes of each kind are subclasses of; kinds that are not here have no interface."""


def load(kind: Kind, part: Any, registered: Catalogue | None = None) -> Any:
    """The class that a part stands for. A text is all that another process needs to load it too.

    Args:
        kind: What it is.
        part: A name, ``distribution:name``, or a file and a class in it, ``./mine.py:Mine``, unless that was read from a
            file (``StoredName``), each also with options in brackets, ``phia[sweeps=paper]``; or a class, or an object.
        registered: Where names are looked up; None: all that is registered in this environment.

    Raises:
        UnknownNameError: If there is no such name.
        NotInstalledError: If it needs a library that is not installed.
        PluginError: If it does not load or does not keep to its interface.
        InputError: If a file cannot be read, or is named by another file.
    """
    if not isinstance(part, str):
        loaded = part if isinstance(part, type) else type(part)
        return _checked(kind, loaded.__name__, loaded)
    part, _ = split_variant(part)
    if not is_file(part):
        entry = registered.find(kind, part) if registered else find(kind, part)
        return _checked(kind, entry.name, _import(entry))
    refuse_stored_code(kind, part)
    return _checked(kind, part, load_from_file(part, _interface(kind) or object))


def refuse_stored_code(role: str, part: Any) -> None:
    """See that no file has code run by naming it.

    Args:
        role: What the part is in a run, such as ``plan_arm``.
        part: As for ``load``.

    Raises:
        InputError: If it is a class in a file, and that was read from a file.
    """
    if isinstance(part, StoredName) and is_file(part):
        raise InputError(
            f"the {role} is {str(part)!r}, a class in a file, and code is not run because a file names it. If you trust "
            f"it, give it yourself, as in --{role.replace('_', '-')} {part}"
        )


def create(kind: Kind, part: Any, options: Mapping[str, Any] | None = None, registered: Catalogue | None = None) -> Any:
    """An object of the class that a part stands for, of a kind that is made from options alone: all but backends.

    Args:
        kind: Planner, arm, topology, goal or scenes.
        part: As for ``load``; an object is taken as it is.
        options: Values, or their text, by name; none with an object, which has its own.
        registered: As for ``load``.

    Raises:
        OptionError: If an option is unknown, of the wrong type or out of range, or given with an object.
        PluginError: If it cannot be made.
        PhframeError: As ``load``.
    """
    loaded = load(kind, part, registered)
    if not isinstance(part, str | type):
        if options:
            raise OptionError(f"{kind} {loaded.__name__} is an object with options of its own: give it none beside it")
        return part
    name, given = merged_options(part, options or {}) if isinstance(part, str) else (part.__name__, options or {})
    with foreign_code(f"{kind} {name!r} cannot be made"):
        return loaded(loaded.options_type.parse(given, f"{kind} {name}"))


def identify(kind: Kind, part: Any, options: Mapping[str, Any] | None = None) -> tuple[Any, Mapping[str, Any]]:
    """A class or an object as its registered name and options, if its class is registered; else as it is.

    Of a text, the name, and the options in its brackets with those beside it.

    Raises:
        OptionError: If there are options beside an object, or an option stands both in brackets and beside them.
        PluginError: If it does not keep to its interface.
    """
    if isinstance(part, str):
        return merged_options(part, options or {})
    own = load(kind, part)
    registered = builtins() if own.__module__.partition(".")[0] == HOME else catalogue()
    names = [entry.name for entry in registered.extensions(kind) if entry.extension.target == _target(own)]
    if isinstance(part, type) or not names:
        return (names or [part])[0], options or {}
    create(kind, part, options)  # refuses options beside it
    return names[0], part.options.model_dump(mode="json", exclude_defaults=True)


def _target(cls: type) -> str:
    return f"{cls.__module__}:{cls.__qualname__}"


def _import(entry: Entry) -> Any:
    module, _, name = entry.extension.target.partition(":")
    what = f"{entry.extension.kind} {entry.name!r}"
    with foreign_code(f"{what}{_origin(entry)} does not load"):
        try:
            return getattr(import_module(module), name)
        except ModuleNotFoundError as error:
            if _is_foreign(error, module) and (gap := missing(entry.distribution, entry.extension.extra)):
                raise NotInstalledError(what, gap.library, gap.remedy) from error
            raise


def _origin(entry: Entry | None) -> str:
    return f" of {entry.distribution} {entry.version}".rstrip() if entry else ""


def _is_foreign(error: ModuleNotFoundError, module: str) -> bool:
    """Whether a module is missing that is not the extension's own."""
    own = module.partition(".")[0]
    return (error.name or own).partition(".")[0] != own


def _interface(kind: Kind) -> type | None:
    return getattr(core, INTERFACES[kind]) if kind in INTERFACES else None


def _checked(kind: Kind, spec: str, loaded: Any) -> Any:
    interface = _interface(kind)
    if interface is None:
        return loaded
    with foreign_code(f"{kind} {spec!r} cannot be looked at"):
        if not (isinstance(loaded, type) and issubclass(loaded, interface)):
            raise PluginError(f"{kind} {spec!r} is not a subclass of phframe.core.{interface.__name__}")
        if absent := sorted(getattr(loaded, "__abstractmethods__", ())):
            raise PluginError(f"{kind} {spec!r} does not implement: {', '.join(absent)}")
    return loaded
