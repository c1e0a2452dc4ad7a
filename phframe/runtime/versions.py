"""Versions of what takes part in a run, for the record."""

from __future__ import annotations

from phframe.core import RunSpec
from phframe.core.run_spec import PARTS
from phframe.registry import Kind, versions


def versions_of(spec: RunSpec) -> dict[str, str]:
    """Versions of Python, phframe, and all that the registered parts of a run come from, by distribution."""
    named = ((Kind(part.removeprefix("plan_")), getattr(spec, part)) for part in PARTS)
    return versions((kind, name) for kind, name in named if isinstance(name, str))
