"""What a link of an arm looks like, for pictures alone."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core.errors import InputError
from phframe.core.value import Floats, Ints, Value, frozen_ints


@dataclass(frozen=True, slots=True, eq=False)
class LinkMesh(Value):
    """A surface of one colour that belongs to a link.

    Attributes:
        link: The link's name in the arm's URDF.
        vertices: ``(n, 3)`` in the frame of the link (m).
        triangles: ``(m, 3)`` rows of ``vertices``, counter-clockwise seen from outside.
        color: Red, green and blue, from 0 to 1.

    Raises:
        InputError: If the arrays do not have these shapes, or a triangle names a vertex that is not there.
    """

    link: str
    vertices: Floats
    triangles: Ints
    color: tuple[float, float, float] = (0.5, 0.5, 0.5)

    def __post_init__(self) -> None:
        self._freeze("vertices")
        object.__setattr__(self, "triangles", frozen_ints(self.triangles))
        if self.vertices.ndim != 2 or self.vertices.shape[1] != 3:
            raise InputError(f"a mesh has vertices (n, 3), not {self.vertices.shape}")
        if self.triangles.ndim != 2 or self.triangles.shape[1] != 3:
            raise InputError(f"a mesh has triangles (m, 3), not {self.triangles.shape}")
        if len(self.triangles) and not 0 <= self.triangles.min() <= self.triangles.max() < len(self.vertices):
            raise InputError(f"a triangle of the mesh names a vertex beyond the {len(self.vertices)} there are")
