"""Which phframe this is."""

from __future__ import annotations

from importlib import metadata

from phframe.core.metadata_fields import version_of


def own_version() -> str:
    """The version of the installed phframe; ``unknown`` in a source tree that is not installed."""
    try:
        return version_of("phframe")
    except metadata.PackageNotFoundError:
        return "unknown"
