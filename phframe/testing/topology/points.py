"""Sets of points for the checks of topology engines, and the plain answers to compare with."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from phframe.core import FloatArray, IntArray
from phframe.core.topology import FLOAT32_SLACK


def point_sets() -> Iterator[tuple[str, FloatArray]]:
    """Named sets of points ``(n, 2)`` (m), read-only; the same ones every time."""
    rng = np.random.default_rng(20220)
    sets = {f"{n} random points": rng.uniform(0.0, 0.6, (n, 2)) for n in (2, 3, 7, 25)}
    sets["two clusters"] = np.vstack([rng.normal(centre, 0.02, (6, 2)) for centre in (0.1, 0.5)])
    sets["points on a line"] = np.column_stack([np.array([0.0, 0.05, 0.15, 0.3, 0.5]), np.full(5, 0.2)])
    sets["a square grid"] = np.array([[0.1 * i, 0.1 * j] for i in range(4) for j in range(3)])
    sets["points of which some coincide"] = np.array([[0.1, 0.1], [0.3, 0.1], [0.1, 0.1], [0.3, 0.4], [0.3, 0.1]])
    for name, points in sets.items():
        points.setflags(write=False)
        yield name, points


def tree_edges(points: FloatArray) -> FloatArray:
    """Lengths of the minimum spanning tree's edges, ascending (Prim's algorithm)."""
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    outside, nearest, lengths = list(range(1, len(points))), distance[0].copy(), []
    while outside:
        closest = min(outside, key=lambda row: nearest[row])
        outside.remove(closest)
        lengths.append(nearest[closest])
        nearest = np.minimum(nearest, distance[closest])
    return np.sort(np.array(lengths))


def clear_radii(points: FloatArray) -> list[float]:
    """Radii (m) that are so far from every distance that rounding cannot matter."""
    distances = np.unique(np.linalg.norm(points[:, None] - points[None], axis=2))
    gaps = np.diff(distances)
    middles = (distances[:-1] + gaps / 2.0)[gaps > 6.0 * FLOAT32_SLACK]
    return [*middles[:: max(1, len(middles) // 6)].tolist(), float(distances[-1]) + 0.1]


def flood_labels(points: FloatArray, radius: float) -> IntArray:
    """Labels ``(n,)`` of the graph that joins points at most ``radius`` (m) apart, in order of first appearance."""
    near = np.linalg.norm(points[:, None] - points[None], axis=2) <= radius
    labels = np.full(len(points), -1)
    for start in range(len(points)):
        if labels[start] < 0:
            label, waiting = labels.max() + 1, [start]
            while waiting:
                row = waiting.pop()
                labels[row] = label
                waiting += np.flatnonzero(near[row] & (labels < 0)).tolist()
    return labels


def partition(labels: IntArray) -> frozenset[frozenset[int]]:
    """Which points are together, whatever the labels are called."""
    return frozenset(frozenset(np.flatnonzero(labels == label).tolist()) for label in set(labels.tolist()))
