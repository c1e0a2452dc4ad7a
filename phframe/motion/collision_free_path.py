"""Collision-free joint paths from a configuration to others: straight where possible, else by a sampling-based planner."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib import import_module
from types import ModuleType

import numpy as np

from phframe.core import ArmError, FloatArray, NotInstalledError, UnknownNameError
from phframe.motion.edges import Edges
from phframe.motion.path_shortcutting import shortened

DEFAULT = "RRTConnect"
"""Among those that found a path in all of 65 problems on Baxter at a shelf, given iterations enough, the fastest."""
PLANNERS = (
    "AORRTC", "BFMT", "BITstar", "BKPIECE1", "BiEST", "FMT", "InformedRRTstar", "KPIECE1", "LBKPIECE1", "RRT",
    "RRTConnect", "RRTstar", "SORRTstar",
)  # fmt: skip
"""Of OMPL by its class names, and BiEST. Not PRM and PRMstar: they end by the clock, so they do not repeat."""


def collision_free_path(
    start: FloatArray,
    goals: FloatArray,
    *,
    lower: FloatArray,
    upper: FloatArray,
    valid: Callable[[FloatArray], bool],
    planner: str = DEFAULT,
    resolution: float,
    stop: Callable[[], bool],
    rng: np.random.Generator,
) -> FloatArray | None:
    """Waypoints ``(k, dof)``, k at least 2, from a configuration to one of several others, or None.

    The straight line is tried first, to the nearest goals first (Euclidean norm); then OMPL searches, and what it finds
    is shortened. Straight edges between the waypoints are valid in steps in which no joint moves by more than the
    resolution. The same inputs give the same bits, whatever ran before, if ``stop`` repeats too.

    Args:
        start: Joint values ``(dof,)``.
        goals: Joint values ``(m, dof)``; those beyond the limits or not valid are left out.
        lower: Lower joint limits ``(dof,)`` (rad or m).
        upper: Upper joint limits ``(dof,)``, above the lower ones (rad or m).
        valid: Whether a configuration ``(dof,)`` is allowed; what it raises comes out of here as it is.
        planner: One of PLANNERS. RRTstar, InformedRRTstar, SORRTstar, BITstar and AORRTC use up all iterations.
        resolution: Most that a joint moves between two configurations that are looked at (rad or m), above 0.
        stop: Asked in each iteration of the planner; True: it gives up.
        rng: The only source of randomness.

    Returns:
        None if nothing was found, or the start or all goals are not valid or beyond the limits.

    Raises:
        ArmError: If arrays do not fit one another, are not finite, or limits or resolution cannot be.
        UnknownNameError: If there is no such planner.
        NotInstalledError: If OMPL is not installed.
    """
    ompl = require_planner(planner)
    _check(start, goals, lower, upper, resolution)
    edges = Edges(valid, resolution)

    def allowed(q: FloatArray) -> bool:
        return bool((lower <= q).all() and (q <= upper).all() and valid(q))

    nearest_first = goals[np.argsort(np.linalg.norm(goals - start, axis=1), kind="stable")]
    ends = np.array([goal for goal in nearest_first if allowed(goal)]) if allowed(start) else goals[:0]
    for goal in ends:
        if edges.allowed(start, goal):
            return np.array([start, goal])
    if not len(ends):
        return None
    path = ompl.search(start, ends, (lower, upper), edges, planner, stop, rng)
    return None if path is None else shortened(path, edges, rng)


def require_planner(name: str) -> ModuleType:
    """See to it that a planner is there; returns the module that runs it.

    Raises:
        UnknownNameError: If there is none of that name.
        NotInstalledError: If OMPL is not installed.
    """
    if name not in PLANNERS:
        raise UnknownNameError("path planner", name, PLANNERS)
    try:
        import_module("ompl.base")  # `import ompl` alone hides that a part of it is broken
    except ImportError as error:
        remedy = 'pip install "phframe[ompl]" (no wheels for Windows and CPython 3.14)'
        raise NotInstalledError(f"path planner {name!r}", "ompl", remedy) from error
    from phframe.motion import ompl_

    return ompl_


def _check(start: FloatArray, goals: FloatArray, lower: FloatArray, upper: FloatArray, resolution: float) -> None:
    shape = np.shape(start)
    if len(shape) != 1 or np.shape(lower) != shape or np.shape(upper) != shape or np.shape(goals)[1:] != shape:
        shapes = ", ".join(str(np.shape(array)) for array in (start, goals, lower, upper))
        raise ArmError(f"start, goals and limits need the shapes (dof,), (m, dof), (dof,), (dof,), not {shapes}")
    if not all(np.isfinite(array).all() for array in (start, goals, lower, upper)):
        raise ArmError("start, goals and joint limits must be finite numbers")
    if not (lower < upper).all():
        raise ArmError(f"joint {int(np.argmin(lower < upper))} has no room between its limits")
    if not (math.isfinite(resolution) and resolution > 0.0):
        raise ArmError(f"resolution must be above 0, not {resolution}")
