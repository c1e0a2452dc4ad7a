"""phframe plans how a robot arm pushes through clutter, with persistent homology.

``phframe.solve`` retrieves a target from a shelf, ``phframe.run`` carries out a ``RunSpec``; everything else is in the
packages. Importing this is cheap: what it names is loaded when it is first used. ``api_version`` is that of what plugins
build on: ``phframe.core``, ``.pushing``, ``.registry``, ``.testing``, ``.runtime.observer``, ``phframe.run`` and ``phframe.solve``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from phframe.registry.extension import API_VERSION as api_version  # noqa: N811
    from phframe.runtime.files import load, save
    from phframe.runtime.run import run
    from phframe.runtime.solve import solve

_LAZY = {
    "api_version": "phframe.registry.extension",
    "load": "phframe.runtime.files",
    "save": "phframe.runtime.files",
    "run": "phframe.runtime.run",
    "solve": "phframe.runtime.solve",
}

__all__ = ["api_version", "load", "run", "save", "solve"]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from phframe.core.version import own_version

        return own_version()
    if name not in _LAZY:
        raise AttributeError(f"module 'phframe' has no attribute {name!r}")
    from importlib import import_module

    if name == "load":
        import_module("phframe.pushing")  # whose decisions episodes hold
    return getattr(import_module(_LAZY[name]), "API_VERSION" if name == "api_version" else name)
