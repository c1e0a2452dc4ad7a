"""Convex hulls of meshes: what collides where a robot's collision geometry is a mesh."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from phframe.core import ArmError, FloatArray, IntArray
from phframe.core.regular_file import read_regular_file
from phframe.core.value import Floats, Ints, Value, frozen_ints
from phframe.urdf.solids import ORIGIN, Vector, rotation
from phframe.urdf.trimesh_ import mesh_points

STL_HEADER, STL_FACET = 84, 50
"""Bytes of a binary STL file before its facets, and of each of them."""
MOST_BYTES, MOST_POINTS = 200_000_000, 500_000
"""Of a mesh; what is beyond is no collision geometry that anything could be planned with."""
NUMBER = rb"[-+.0-9eE]+"


@dataclass(frozen=True, slots=True, eq=False)
class ConvexHull(Value):
    """The convex hull of a mesh, in the frame of a link.

    Attributes:
        file: The mesh's.
        scale: By which the file's coordinates are multiplied.
        vertices: Corners ``(k, 3)`` of the hull, scaled, in the axes of the file (m).
        triangles: ``(m, 3)`` rows of ``vertices``, counter-clockwise seen from outside.
        at: Origin of the file in the frame of the link (m).
        rpy: Rotation there (rad), about the fixed axes x, y, z.
        part: What it is of.
        name: Of its element in the URDF, without what it is for; empty: of link and part.
    """

    file: str
    scale: Vector
    vertices: Floats
    triangles: Ints
    at: Vector = ORIGIN
    rpy: Vector = ORIGIN
    part: str = ""
    name: str = ""
    kind: ClassVar[str] = "hull"

    def __post_init__(self) -> None:
        self._freeze("vertices")
        object.__setattr__(self, "triangles", frozen_ints(self.triangles))

    def corners(self) -> FloatArray:
        """Its corners ``(k, 3)`` in the frame of the link (m)."""
        return np.asarray(self.vertices @ rotation(self.rpy).T + self.at)

    def wavefront(self) -> bytes:
        """The hull as an OBJ file, in the axes of the mesh's file (m)."""
        corners = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.vertices.tolist()]
        faces = [f"f {a} {b} {c}" for a, b, c in (self.triangles + 1).tolist()]
        return "\n".join([*corners, *faces, ""]).encode()


def read_hull(path: Path, scale: Vector) -> tuple[FloatArray, IntArray]:
    """Corners ``(k, 3)`` (m) and triangles ``(m, 3)`` of the convex hull of a mesh file.

    Raises:
        ArmError: If the file is no mesh, or flat.
        NotInstalledError: If what reads this format is not installed.
    """
    try:
        content = read_regular_file(path, MOST_BYTES + 1)
        if len(content) > MOST_BYTES:
            raise ValueError(f"it is larger than {MOST_BYTES // 1_000_000} MB")
        return _hull(content, path.suffix.lower(), scale)
    except (OSError, ValueError) as error:
        raise ArmError(f"cannot make a convex hull of the mesh {path}: {_first_line(error)}") from None


@lru_cache(maxsize=256)
def _hull(content: bytes, suffix: str, scale: Vector) -> tuple[FloatArray, IntArray]:
    """By Quickhull (Barber, Dobkin and Huhdanpaa 1996); once for a file's content."""
    points = np.unique(_points(content, suffix) * scale, axis=0)
    if len(points) < 4 or not np.isfinite(points).all():
        raise ValueError(f"it has {len(points)} points in space where four finite ones are needed")
    if len(points) > MOST_POINTS:
        raise ValueError(f"it has {len(points)} points; at most {MOST_POINTS} are taken. Give a coarser mesh.")
    hull = _quickhull(points)
    triangles = hull.simplices.copy()
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    triangles[inwards] = triangles[inwards][:, ::-1]
    used, renumbered = np.unique(triangles, return_inverse=True)
    return points[used], renumbered.reshape(triangles.shape)


def _points(content: bytes, suffix: str) -> FloatArray:
    """Corners ``(n, 3)`` of all triangles of a mesh, in the units of its file."""
    if suffix == ".stl":
        return _stl(content)
    if suffix == ".obj":
        return _numbers(rb"^\s*v\s+(%s)\s+(%s)\s+(%s)", content)
    return mesh_points(content, suffix)


def _stl(content: bytes) -> FloatArray:
    count = int.from_bytes(content[STL_HEADER - 4 : STL_HEADER], "little")
    if len(content) != STL_HEADER + STL_FACET * count:
        return _numbers(rb"^\s*vertex\s+(%s)\s+(%s)\s+(%s)", content)
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(content, facet, count, STL_HEADER)["corners"].reshape(-1, 3).astype(np.float64)


def _numbers(line: bytes, content: bytes) -> FloatArray:
    found = re.findall(line % (NUMBER, NUMBER, NUMBER), content, re.MULTILINE)
    return np.array(found, dtype=np.bytes_).astype(np.float64).reshape(-1, 3)


def _first_line(error: Exception) -> str:
    return getattr(error, "strerror", None) or next(iter(str(error).splitlines()), type(error).__name__)


def _quickhull(points: FloatArray) -> Any:
    from scipy.spatial import ConvexHull as QuickHull  # its import takes a fifth of a solve, and few arms have meshes
    from scipy.spatial import QhullError

    try:
        return QuickHull(points)
    except QhullError as error:
        raise ValueError(_first_line(error)) from None
