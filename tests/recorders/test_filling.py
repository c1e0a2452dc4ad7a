from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import FloatArray
from phframe.recorders.filling import filling


def regular(corners: int, size: float, turned: float, scale: float) -> FloatArray:
    angles = turned + 2 * math.pi * np.arange(corners) / corners
    return size * np.column_stack([scale * np.cos(angles), np.sin(angles)])


def distance_to(lines: list[FloatArray], points: FloatArray) -> FloatArray:
    pieces = np.array([[line[i], line[i + 1]] for line in lines for i in range(len(line) - 1)])
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    squared = np.maximum((along**2).sum(axis=1), 1e-18)
    part = np.clip(((points[:, None] - start) * along).sum(axis=2) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points[:, None] - (start + part[..., None] * along), axis=2).min(axis=1))


@settings(max_examples=40, deadline=None)
@given(st.integers(4, 8), st.floats(0.01, 1.0), st.floats(0.0, 6.0), st.floats(1.0, 4.0), st.integers(6, 30))
def test_thick_lines_cover_a_polygon_and_nothing_else(
    corners: int, size: float, turned: float, scale: float, lines: int
) -> None:
    vertices = regular(corners, size, turned, scale)
    drawn, half = filling(vertices, lines)
    inside = np.random.default_rng(0).dirichlet(np.ones(corners), 200) @ vertices
    edges = [np.vstack([vertices, vertices[:1]])]
    away = distance_to(edges, inside) > half
    assert (distance_to(drawn, inside[away]) <= half * (1 + 1e-6)).all(), "covered but for the tips of the corners"
    ends = np.vstack(drawn)
    assert (distance_to(edges, ends) >= half * (1 - 1e-6)).all(), "no line reaches beyond the edge"


def test_rectangle_is_straight_to_its_edges() -> None:
    vertices = np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 0.6], [0.0, 0.6]])
    drawn, half = filling(vertices, 40)
    along_edge = np.column_stack([np.full(50, 0.0), np.linspace(half, 0.6 - half, 50)])
    assert (distance_to(drawn, along_edge) <= half * (1 + 1e-9)).all()


def test_polygon_without_area_draws_nothing() -> None:
    drawn, half = filling(np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 0.0], [0.0, 0.0]]), 10)
    assert drawn == []
    assert half == 0.0
