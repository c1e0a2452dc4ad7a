"""Convex hulls of mesh files: of every format the same, found where URDFs say they are, refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from phframe.core import ArmError, NotInstalledError
from phframe.urdf.convex_hull import read_hull
from phframe.urdf.mesh_files import find_mesh
from tests.urdf.meshes import FORMATS, write_box

SIZE = (0.2, 0.06, 0.04)
WHOLE = (1.0, 1.0, 1.0)


@pytest.mark.parametrize("name", FORMATS)
def test_of_a_box_the_hull_is_the_box(tmp_path: Path, name: str) -> None:
    write_box(tmp_path / name, SIZE)
    vertices, triangles = read_hull(tmp_path / name, WHOLE)
    assert vertices.shape == (8, 3)
    np.testing.assert_allclose(np.ptp(vertices, axis=0), SIZE, rtol=1e-6)
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert volume == pytest.approx(np.prod(SIZE), rel=1e-5), "closed, and faces outwards"


def test_of_a_scaled_and_mirrored_mesh_the_hull_faces_outwards_too(tmp_path: Path) -> None:
    write_box(tmp_path / "a.obj", SIZE)
    vertices, triangles = read_hull(tmp_path / "a.obj", (2.0, -1.0, 1.0))
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0 == pytest.approx(2.0 * np.prod(SIZE))


def test_collada_is_read_where_trimesh_is_installed(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("collada")
    box = trimesh.creation.box(SIZE)
    (tmp_path / "a.dae").write_bytes(trimesh.exchange.dae.export_collada(box))
    vertices, _ = read_hull(tmp_path / "a.dae", WHOLE)
    np.testing.assert_allclose(np.ptp(vertices, axis=0), SIZE, rtol=1e-6)
    (tmp_path / "bad.dae").write_bytes(b"<COLLADA")
    with pytest.raises(ArmError, match=r"bad\.dae: trimesh cannot read it"):
        read_hull(tmp_path / "bad.dae", WHOLE)


@pytest.mark.needs_meshes
def test_what_reads_collada_is_named_where_it_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("trimesh")
    monkeypatch.setitem(__import__("sys").modules, "collada", None)
    (tmp_path / "b.dae").write_bytes(b"<COLLADA/>")
    with pytest.raises(NotInstalledError, match=r"type \.dae needs collada.*phframe\[meshes\].*STL or OBJ"):
        read_hull(tmp_path / "b.dae", WHOLE)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("none.stl", None, "No such file"),
        ("empty.obj", b"", "0 points"),
        ("words.stl", b"solid words\nendsolid words\n", "0 points"),
        ("short.stl", b"\0" * 80 + b"\x05\0\0\0", "0 points"),
        ("flat.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", "flat.obj: "),
        ("huge.obj", b"v 1e999 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n", "four finite ones"),
        ("odd.obj", b"v 1-2 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n", "odd.obj: "),
    ],
)
def test_what_has_no_hull_is_one_line(tmp_path: Path, name: str, content: bytes | None, said: str) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(ArmError, match=said) as caught:
        read_hull(tmp_path / name, WHOLE)
    assert "\n" not in str(caught.value)


def test_meshes_are_found_where_urdfs_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    package, elsewhere = tmp_path / "src" / "my_robot", tmp_path / "opt" / "share" / "hands"
    urdf = package / "urdf"
    for file in (package / "meshes" / "arm.stl", elsewhere / "hand.stl", urdf / "near.obj"):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(b"")
    urdf.mkdir(exist_ok=True)
    assert find_mesh("package://my_robot/meshes/arm.stl", urdf) == package / "meshes" / "arm.stl"
    assert find_mesh("meshes/arm.stl", urdf) == package / "meshes" / "arm.stl", "in a folder above"
    assert find_mesh("near.obj", urdf) == urdf / "near.obj"
    assert find_mesh(f"file://{urdf / 'near.obj'}", None) == urdf / "near.obj"
    with pytest.raises(ArmError, match=r"'package://hands/hand\.stl' .* looked in .*ROS_PACKAGE_PATH \(not set\)"):
        find_mesh("package://hands/hand.stl", urdf)
    for path in (elsewhere, elsewhere.parent, elsewhere.parent.parent):
        monkeypatch.setenv("ROS_PACKAGE_PATH", f"/nowhere:{path}")
        assert find_mesh("package://hands/hand.stl", urdf) == elsewhere / "hand.stl"
    with pytest.raises(ArmError, match="looked nowhere, since the URDF is not a file"):
        find_mesh("near.obj", None)
    with pytest.raises(ArmError, match="looked there only"):
        find_mesh("/nowhere/near.obj", urdf)


@pytest.mark.parametrize("suffix", ["ply", "glb", "off"])
def test_what_is_not_collada_needs_no_reader_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str
) -> None:
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.box(SIZE).export(tmp_path / f"a.{suffix}")
    monkeypatch.setitem(__import__("sys").modules, "collada", None)
    vertices, _ = read_hull(tmp_path / f"a.{suffix}", WHOLE)
    np.testing.assert_allclose(np.ptp(vertices, axis=0), SIZE, rtol=1e-6)
