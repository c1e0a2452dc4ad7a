"""A robot of boxes with its boxes written as mesh files: what engines make of the two must be the same."""

from __future__ import annotations

import struct
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from phframe.urdf.convex_hull import ConvexHull, read_hull
from phframe.urdf.solids import Solid

FORMATS = ("binary.stl", "ascii.stl", "corners.obj")


def write_box(path: Path, size: tuple[float, ...], scale: float = 1.0) -> None:
    """A box about the origin as a mesh file of the format that its name says."""
    corners = Solid("box", tuple(length / scale for length in size)).corners()
    obj = path.with_suffix(".first.obj")
    obj.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in corners.tolist()), "utf-8")
    vertices, triangles = read_hull(obj, (1.0, 1.0, 1.0))
    hull = ConvexHull("", (1.0, 1.0, 1.0), vertices, triangles)
    facets = vertices[triangles]
    if path.suffix == ".obj":
        path.write_bytes(hull.wavefront())
    elif "ascii" in path.name:
        loops = ("".join(f"   vertex {x:e} {y:e} {z:e}\n" for x, y, z in facet) for facet in facets.tolist())
        body = "".join(f" facet normal 0 0 0\n  outer loop\n{loop}  endloop\n endfacet\n" for loop in loops)
        path.write_text(f"solid box\n{body}endsolid box\n", "utf-8")
    else:
        rows = b"".join(struct.pack("<12fH", 0, 0, 0, *facet.ravel(), 0) for facet in facets.astype(np.float32))
        path.write_bytes(b"\0" * 80 + struct.pack("<I", len(facets)) + rows)


def meshed(text: str, folder: Path, prefix: str = "") -> str:
    """A URDF whose boxes that collide are meshes in a folder, in millimetres, named by a prefix and the file's name."""
    root = ET.fromstring(text)
    for number, geometry in enumerate(root.iterfind("link/collision/geometry")):
        box = geometry.find("box")
        if box is None:
            continue
        name = f"{number}.{FORMATS[number % len(FORMATS)]}"
        write_box(folder / name, tuple(float(word) for word in box.attrib["size"].split()), scale=1e-3)
        geometry.remove(box)
        ET.SubElement(geometry, "mesh", filename=f"{prefix}{name}", scale="0.001 0.001 0.001")
    return ET.tostring(root, encoding="unicode")
