"""What is drawn of an arm: rigid bodies made of primitives and surfaces. They know no viewer."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product
from typing import Literal

import numpy as np

from phframe.core import FloatArray, Floats, Ints, Outline, Value, compose, planar_pose
from phframe.recorders import palette


@dataclass(frozen=True, slots=True, eq=False)
class Primitive(Value):
    """A box, cylinder or sphere.

    Attributes:
        kind: Its shape.
        size: Box: lengths along x, y, z (m). Cylinder: radius and length, along its own z. Sphere: radius.
        pose: ``(7,)`` of its centre in the frame of the body.
    """

    kind: Literal["box", "cylinder", "sphere"]
    size: tuple[float, ...]
    pose: Floats = field(default_factory=lambda: planar_pose(0.0, 0.0))

    def __post_init__(self) -> None:
        self._freeze("pose")


@dataclass(frozen=True, slots=True, eq=False)
class Surface(Value):
    """Triangles.

    Attributes:
        vertices: ``(n, 3)`` in the frame of the body (m).
        triangles: ``(m, 3)`` rows of ``vertices``, counter-clockwise seen from outside.
    """

    vertices: Floats
    triangles: Ints


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of a body that has one shape and one colour.

    Attributes:
        name: Unique in the body.
        shape: In the frame of the body.
        color: What it is drawn in.
    """

    name: str
    shape: Primitive | Surface
    color: palette.Color


@dataclass(frozen=True, slots=True)
class Body:
    """Something rigid that moves as a whole.

    Attributes:
        name: Unique in what is drawn.
        pieces: What is to be seen of it.
    """

    name: str
    pieces: tuple[Piece, ...]


def points_of(shape: Primitive | Surface) -> FloatArray:
    """Points ``(n, 3)`` in the frame of the body whose hull holds a shape: its vertices, or the corners of a box around."""
    if isinstance(shape, Surface):
        return shape.vertices
    lengths = {"box": shape.size, "cylinder": (2 * shape.size[0],) * 2 + shape.size[1:]}.get(
        shape.kind, (2 * shape.size[0],) * 3
    )
    corners = np.array(list(product((-0.5, 0.5), repeat=3))) * lengths
    return np.array([compose(shape.pose, planar_pose(*corner))[:3] for corner in corners])


def prism(outline: Outline) -> Surface:
    """An outline made solid, from its bottom to its top; every face has corners of its own, so that edges are sharp."""
    points = outline.vertices
    low, high = (np.column_stack([points, np.full(len(points), z)]) for z in (outline.bottom, outline.top))
    quads = np.stack([low, np.roll(low, -1, axis=0), np.roll(high, -1, axis=0), high], axis=1)
    faces: list[FloatArray] = [high, low[::-1], *quads]
    starts = np.cumsum([0, *(len(face) for face in faces[:-1])])
    fans = [start + _fan(len(face)) for start, face in zip(starts, faces, strict=True)]
    return Surface(np.vstack(faces), np.vstack(fans))


def _fan(corners: int) -> np.ndarray[tuple[int, int], np.dtype[np.int64]]:
    """Triangles ``(k - 2, 3)`` that fill a convex polygon of ``k`` corners."""
    second = np.arange(1, corners - 1)
    return np.column_stack([np.zeros_like(second), second, second + 1])


def normals(surface: Surface) -> FloatArray:
    """Unit normals ``(n, 3)`` at the vertices: the mean of those of the triangles that meet there, by area."""
    a, b, c = (surface.vertices[surface.triangles[:, corner]] for corner in range(3))
    across = np.cross(b - a, c - a)
    sums = np.zeros_like(surface.vertices)
    for corner in range(3):
        np.add.at(sums, surface.triangles[:, corner], across)
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.asarray(sums / np.where(lengths > 0.0, lengths, 1.0))
