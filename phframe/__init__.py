"""phframe plans how a robot arm pushes through clutter, with persistent homology.

``phframe.solve`` retrieves a target from a shelf; everything else is in the packages. Importing this is cheap: what it
names is loaded when it is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from phframe.runtime.files import load, save
    from phframe.runtime.solve import solve

api_version = 1
"""Of what plugins build on: ``phframe.core``, ``.pushing``, ``.registry``, ``.testing`` and ``phframe.solve``."""

_LAZY = {"solve": "phframe.runtime.solve", "load": "phframe.runtime.files", "save": "phframe.runtime.files"}

__all__ = ["api_version", "load", "save", "solve"]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("phframe")
    if name not in _LAZY:
        raise AttributeError(f"module 'phframe' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_LAZY[name]), name)
