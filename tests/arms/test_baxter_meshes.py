"""Rethink's meshes lie on our links: where the covers are, which were fitted to the same surfaces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")
pytest.importorskip("trimesh", reason="needs the extra 'meshes'")
pytest.importorskip("collada", reason="needs the extra 'meshes'")

from phframe.arms.baxter import meshes
from phframe.arms.baxter.model import Side
from phframe.core import ArmError, FloatArray
from phframe.urdf.reader import read_robot
from tests.arms.baxter_arm import SIDES, baxter

pytestmark = [pytest.mark.needs_meshes, pytest.mark.needs_baxter]

NO_COVERS = {"screen"}
"""Links that have a mesh and nothing that collides."""
ROUGH = {"head": 0.25, "base": 0.31, "upper_forearm": 0.11, "upper_shoulder": 0.04, "wrist": 0.026}
"""By how much (m) covers differ that leave out what nothing can hit, or, of the head, are large on purpose."""


def surfaces(side: Side) -> dict[str, FloatArray]:
    """The vertices on each link."""
    found: dict[str, list[FloatArray]] = {}
    for mesh in baxter(side).meshes():
        found.setdefault(mesh.link, []).append(mesh.vertices)
    return {link: np.vstack(vertices) for link, vertices in found.items()}


@pytest.mark.parametrize("side", SIDES)
def test_every_link_with_covers_has_a_mesh_where_they_are(side: Side) -> None:
    covers = {link: solids for link, solids in read_robot(baxter(side).urdf()).collision_geometry.items() if solids}
    found = surfaces(side)
    assert set(found) == set(covers) | NO_COVERS
    for link, solids in covers.items():
        corners = np.vstack([solid.corners() for solid in solids])
        vertices = found[link]
        close = ROUGH.get(link.removeprefix("left_").removeprefix("right_"), 0.008)
        for end in (np.min, np.max):
            np.testing.assert_allclose(end(corners, axis=0), end(vertices, axis=0), atol=close, err_msg=link)


def test_meshes_have_colours_and_few_are_black() -> None:
    found = baxter("left").meshes()
    colors = np.array([mesh.color for mesh in found])
    assert ((colors >= meshes.DARKEST) & (colors <= 1.0)).all()
    assert (colors[:, 0] > 3.0 * colors[:, 2]).any(), "Baxter is red"


def test_without_the_package_there_are_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(meshes, "PACKAGE", "no-such-package")
    assert baxter("left").meshes() == ()


def test_a_file_that_is_missing_is_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(meshes, "FOLDER", tmp_path)
    with pytest.raises(ArmError, match=r"cannot read Baxter's mesh .*\.DAE"):
        baxter("left").meshes()
