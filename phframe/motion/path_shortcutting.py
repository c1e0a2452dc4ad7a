"""Path shortcutting: a joint path gets shorter by straight lines between places on it."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray
from phframe.motion.edges import Edges

TRIES = 40
"""Shortcuts tried between places drawn at random."""
PATIENCE = 15
"""Tries in vain, one after the other, before a path counts as short."""


def shortened(path: FloatArray, edges: Edges, rng: np.random.Generator) -> FloatArray:
    """A path ``(k, dof)`` with the same ends, valid where ``path`` is, never longer by the Euclidean norm.

    First corners are left out; then straight lines are tried between two places drawn evenly along the path
    (R. Geraerts and M. Overmars, "Creating high-quality paths for motion planning", 2007); then corners again.

    Args:
        path: Valid waypoints ``(k, dof)``.
        edges: Says which straight lines are valid.
        rng: The only source of randomness.
    """
    path, vain = _without_corners(path, edges), 0
    for _ in range(TRIES):
        if vain == PATIENCE or len(path) == 2:
            break
        shorter = _shortcut(path, edges, rng)
        path, vain = (path, vain + 1) if shorter is None else (shorter, 0)
    return _without_corners(path, edges)


def _without_corners(path: FloatArray, edges: Edges) -> FloatArray:
    """From each waypoint straight on to the farthest one that can be reached so."""
    kept, here = [0], 0
    while here < len(path) - 1:
        ahead = range(len(path) - 1, here + 1, -1)
        here = next((there for there in ahead if edges.allowed(path[here], path[there])), here + 1)
        kept.append(here)
    return path[kept]


def _shortcut(path: FloatArray, edges: Edges, rng: np.random.Generator) -> FloatArray | None:
    """The path with one shortcut, or None where the places drawn do not allow one."""
    (first, start), (last, end) = (_place(path, edges, fraction) for fraction in np.sort(rng.random(2)).tolist())
    if first == last or not edges.allowed(start, end):
        return None
    joined = np.vstack([path[: first + 1], start, end, path[last + 1 :]])
    moved = np.abs(np.diff(joined, axis=0)).max(axis=1) > 0.0
    return np.asarray(joined[np.concatenate([[True], moved])])


def _place(path: FloatArray, edges: Edges, fraction: float) -> tuple[int, FloatArray]:
    """The place ``(dof,)`` on the path at a fraction of its length, and the edge it is on; one where that was looked at."""
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    ends = np.cumsum(lengths)
    along = fraction * ends[-1]
    edge = min(int(np.searchsorted(ends, along)), len(lengths) - 1)
    steps = edges.steps(path[edge], path[edge + 1])
    step = round(steps * float(along - ends[edge] + lengths[edge]) / float(lengths[edge]))
    return edge, path[edge] + step / steps * (path[edge + 1] - path[edge])
