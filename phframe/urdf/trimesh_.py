"""Corners of meshes in formats that trimesh reads, COLLADA among them; run as a process of its own by ``mesh_points``."""

from __future__ import annotations

from importlib.util import find_spec
from io import BytesIO

import numpy as np

from phframe.core import FloatArray, NotInstalledError
from phframe.core.bounded_process import ProcessEndedError, ProcessLimits, answer, answer_of

COLLADA = (".dae", ".zae")
"""Suffixes of what trimesh reads by a library of its own."""
READ, REFUSED = b"+", b"-"
"""How an answer begins: with corners after it, or with the reason."""


def mesh_points(content: bytes, suffix: str, limits: ProcessLimits | None = None) -> FloatArray:
    """Corners ``(n, 3)`` of all triangles of a mesh, turned and scaled as its file says.

    Args:
        content: Of the file.
        suffix: Of its name, which tells the format.
        limits: What reading it may take; None: as much as a detailed mesh needs.

    Raises:
        NotInstalledError: If what reads this format is not installed.
        ValueError: If it is no mesh, or reading it takes too much.
    """
    libraries = ("trimesh", "collada") if suffix in COLLADA else ("trimesh",)
    missing = next((library for library in libraries if find_spec(library) is None), None)
    if missing is not None:
        remedy = 'pip install "phframe[meshes]", or give the collision geometry as STL or OBJ'
        raise NotInstalledError(f"a collision mesh of the type {suffix or 'without a suffix'}", missing, remedy)
    try:
        found = answer_of("phframe.urdf.trimesh_", suffix.encode() + b"\n" + content, limits or ProcessLimits())
    except ProcessEndedError as error:
        raise ValueError(f"trimesh cannot read it: {error}") from None
    if found[:1] == REFUSED:
        raise ValueError(f"trimesh cannot read it: {found[1:].decode(errors='replace')}")
    return np.frombuffer(found[1:], dtype=np.float64).reshape(-1, 3)


def _read(question: bytes) -> bytes:
    import trimesh

    suffix, _, content = question.partition(b"\n")
    try:
        scene = trimesh.load_scene(BytesIO(content), file_type=suffix.decode()[1:])
        points = np.asarray(scene.to_geometry().vertices, dtype=np.float64).reshape(-1, 3)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - its readers raise anything, of XML, of zip files, of missing keys
        return REFUSED + next(iter(str(error).splitlines()), type(error).__name__).encode(errors="replace")
    return READ + points.tobytes()


if __name__ == "__main__":
    answer(_read)
