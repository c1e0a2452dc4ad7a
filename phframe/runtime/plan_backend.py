"""The engine that plans are made in where an engine of joints carries them out, and its fitted options."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from typing import Any

PYMUNK_FITTED: Mapping[str, Any] = {"standing_radius": 2.0 / 3.0, "arm_acceleration": 10.0}
FAST_FITTED: Mapping[str, Any] = {"arm_acceleration": 10.0, "object_friction": 0.15, "stall_lag": 0.02}
FITTED: Mapping[str, Mapping[str, Any]] = {"pymunk": PYMUNK_FITTED, "fast": FAST_FITTED}
"""Options of each planar engine, fitted to MuJoCo; see docs/fidelity.md."""


def default_plan_backend() -> str:
    """The fastest planar engine that is installed: ``fast`` where there is numba (extra ``fast``), else ``pymunk``."""
    return "pymunk" if find_spec("numba") is None else "fast"
