"""Versions of what takes part in a run, for the record, and the kind of processor that it runs on."""

from __future__ import annotations

import platform
from functools import cache

import numpy as np

from phframe.core import RunSpec
from phframe.core.run_spec import PARTS
from phframe.registry import Kind, versions

CPU = "cpu"
"""The key of the processor among versions; it is none of a library, and can be had nowhere."""


def versions_of(spec: RunSpec) -> dict[str, str]:
    """Versions of Python, phframe, and all that the registered parts of a run come from, by distribution; and ``cpu``."""
    named = ((Kind(part.removeprefix("plan_")), getattr(spec, part)) for part in PARTS)
    return {**versions((kind, name) for kind, name in named if isinstance(name, str)), CPU: _cpu()}


@cache
def _cpu() -> str:
    """The architecture, and the sets of instructions that numpy uses here: by others sums come out otherwise in the last bit."""
    found = np.show_config(mode="dicts") or {}
    simd = found.get("SIMD Extensions", {})
    return " ".join([platform.machine(), *simd.get("baseline", ()), *simd.get("found", ())])
