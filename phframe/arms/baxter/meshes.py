"""What Baxter really looks like: Rethink Robotics' meshes, from the package example-robot-data (extra ``meshes``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import metadata
from importlib.util import find_spec
from math import pi
from pathlib import Path

import numpy as np

from phframe.arms.baxter import figures
from phframe.arms.baxter.model import SIDES, TIP, Side, fingers
from phframe.core import ArmError, FloatArray, LinkMesh
from phframe.urdf.solids import ORIGIN, Vector, rotation

PACKAGE = "example-robot-data"
FOLDER = Path("cmeel.prefix/share/example-robot-data/robots/baxter_description/meshes")
RIGHT_ANGLE = figures.RIGHT_ANGLE
GRIPPER_BASE = 0.025
"""Of the gripper's base on the hand, along its z (m)."""
PAD_AT: Vector = (0.0, 0.01725, 0.1127)
"""Of the pad on the left finger, in Rethink's axes (m)."""
PLAIN = (0.3, 0.3, 0.32)
"""Colour of the torso, whose file has none."""
DARKEST = 0.07
"""Of a colour channel: some of the files' parts are so black that nothing of their shape would be seen."""


@dataclass(frozen=True, slots=True)
class Placed:
    """A mesh file on a link.

    Attributes:
        file: In the package's folder.
        link: Of our URDF.
        at: Origin of the file, in the axes given (m).
        rpy: Rotation of the file there (rad).
        from_tip: The axes are Rethink's gripper's (z ahead) at our fingertip or finger; else the link's own.
    """

    file: str
    link: str
    at: Vector = ORIGIN
    rpy: Vector = ORIGIN
    from_tip: bool = False


BODY = (
    Placed("torso/base_link.DAE", "base"),
    Placed("base/PEDESTAL.DAE", "pedestal"),
    Placed("head/H0.DAE", "head", (0.0, 0.0, 0.00953)),
    Placed("head/H1.DAE", "screen", (0.0, -0.00953, -0.0347), (0.0, -RIGHT_ANGLE, 0.0)),
)
ARM = {
    "upper_shoulder": "upper_shoulder/S0.DAE",
    "lower_shoulder": "lower_shoulder/S1.DAE",
    "upper_elbow": "upper_elbow/E0.DAE",
    "lower_elbow": "lower_elbow/E1.DAE",
    "upper_forearm": "upper_forearm/W0.DAE",
    "lower_forearm": "lower_forearm/W1.DAE",
    "wrist": "wrist/W2.DAE",
}


def baxter_meshes(side: Side) -> tuple[LinkMesh, ...]:
    """The meshes of all links, none where the extra ``meshes`` is not installed.

    Args:
        side: The arm that moves.

    Raises:
        ArmError: If a file is missing or cannot be read.
    """
    folder = _folder()
    if folder is None:
        return ()
    read = {name: tuple(_surfaces(folder / name)) for name in {placed.file for placed in _all(side)}}
    return tuple(_on_link(placed, *surface) for placed in _all(side) for surface in read[placed.file])


def _folder() -> Path | None:
    """Where the files are; None if the extra is not installed."""
    if any(find_spec(library) is None for library in ("trimesh", "collada")):
        return None
    try:
        return Path(str(metadata.distribution(PACKAGE).locate_file(FOLDER)))
    except metadata.PackageNotFoundError:
        return None


def _all(side: Side) -> Iterator[Placed]:
    yield from BODY
    for each in SIDES:
        yield from (Placed(file, f"{each}_{link}") for link, file in ARM.items())
        yield from _gripper(each, TIP if each == side else f"{each}_{TIP}")


def _gripper(side: Side, tip: str) -> Iterator[Placed]:
    base = (0.0, 0.0, GRIPPER_BASE - figures.TIP_AT[2])
    yield Placed("electric_gripper/electric_gripper_base.DAE", tip, base, (-RIGHT_ANGLE, pi, 0.0), from_tip=True)
    for link, sign, turned in zip(fingers(side).links, (1.0, -1.0), (pi, 0.0), strict=True):
        x, y, z = PAD_AT
        for file, at in (("extended_narrow", ORIGIN), ("paddle_tip", (x, sign * y, z))):
            yield Placed(f"electric_gripper/fingers/{file}.DAE", link, at, (0.0, 0.0, turned), from_tip=True)


def _surfaces(path: Path) -> Iterator[tuple[FloatArray, FloatArray, tuple[float, float, float]]]:
    """Vertices ``(n, 3)``, triangles ``(m, 3)`` and colour of every surface in a file."""
    import trimesh

    try:
        scene = trimesh.load_scene(path)
    except (OSError, ValueError) as error:
        raise ArmError(f"cannot read Baxter's mesh {path}: {error}") from None
    for mesh in scene.dump():
        material = getattr(mesh.visual, "material", None)
        color = (
            PLAIN
            if material is None
            else tuple(max(DARKEST, float(channel) / 255.0) for channel in material.main_color[:3])
        )
        yield mesh.vertices, mesh.faces, (color[0], color[1], color[2])


def _on_link(
    placed: Placed, vertices: FloatArray, triangles: FloatArray, color: tuple[float, float, float]
) -> LinkMesh:
    there = vertices @ rotation(placed.rpy).T + placed.at
    if placed.from_tip:
        there = there @ rotation(figures.TIP_TURN)
    return LinkMesh(placed.link, there, np.asarray(triangles, dtype=np.int64), color)
