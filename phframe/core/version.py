"""Which phframe this is."""

from __future__ import annotations

from importlib import metadata


def own_version() -> str:
    """The version of the installed phframe; ``unknown`` in a source tree that is not installed."""
    try:
        return metadata.version("phframe")
    except metadata.PackageNotFoundError:
        return "unknown"
