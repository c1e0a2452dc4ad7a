"""Versions of what took part, for the record."""

from __future__ import annotations

import platform
from importlib import metadata

_ALWAYS = ("phframe", "numpy")
_LIBRARIES = {
    "pymunk": "pymunk",
    "mujoco": "mujoco",
    "pybullet": "pybullet",
    "ripser": "ripser",
    "single-linkage": "scipy",
}


def versions(*parts: str) -> dict[str, str]:
    """Versions of Python, phframe, numpy, and the libraries behind the named backends and engines."""
    libraries = dict.fromkeys((*_ALWAYS, *(_LIBRARIES[part] for part in parts if part in _LIBRARIES)))
    return {"python": platform.python_version(), **{name: _version(name) for name in libraries}}


def _version(distribution: str) -> str:
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return "unknown"
