"""What there is, by name: the one hook of plugins and built-ins, discovery, and loading."""

from phframe.registry.catalogue import Broken, Catalogue, Entry
from phframe.registry.extension import API_VERSION, Extension, Kind
from phframe.registry.hookspec import hookimpl
from phframe.registry.load import create, identify, load, refuse_stored_code
from phframe.registry.manager import builtins, catalogue, discover, look_up
from phframe.registry.versions import versions

__all__ = [
    "API_VERSION",
    "Broken",
    "Catalogue",
    "Entry",
    "Extension",
    "Kind",
    "builtins",
    "catalogue",
    "create",
    "discover",
    "hookimpl",
    "identify",
    "load",
    "look_up",
    "refuse_stored_code",
    "versions",
]
