"""A scene as URDF: whole with everything fixed, or in parts that can be put into a simulator one by one.

URDF knows no free bodies that all readers agree on, and no friction. So a whole scene is a still picture, for planning
scenes and collision checks; the parts are for simulators, with a list of where they belong. The friction in them is
PyBullet's, which multiplies the coefficients of the two bodies: the board has 1, so that the objects' own remain.
"""

from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping, Sequence

from phframe.core import Scene, SceneObject, coulomb_with_board
from phframe.geometry.slabs import PANEL, Slab, slabs

FORMAT = 1
"""Of the list of parts."""
ROOT = "shelf"
"""The link whose frame is the shelf frame."""
SHELF_FILE, LIST_FILE, FOLDER = "shelf.urdf", "poses.json", "objects"
WOOD, PLAIN, WANTED = "0.72 0.55 0.38 1", "0.35 0.45 0.6 1", "0.85 0.2 0.15 1"
Vector = tuple[float, float, float]


def scene_to_urdf(scene: Scene) -> str:
    """The shelf and all objects as one robot in which every link is fixed to ``shelf``."""
    robot = ET.Element("robot", name=_plain(scene.name))
    _add_shelf(robot, scene)
    for link, item in zip(object_links(scene), scene.objects, strict=True):
        _add_object(robot, link, scene, item)
        _fix(robot, link, position_of(item), item.yaw)
    return _written(robot)


def scene_parts(scene: Scene) -> dict[str, str]:
    """The shelf, each object and the list of their poses: texts by the path of their file."""
    shelf = ET.Element("robot", name=ROOT)
    _add_shelf(shelf, scene)
    parts = {SHELF_FILE: _written(shelf)}
    for link, item in zip(object_links(scene), scene.objects, strict=True):
        robot = ET.Element("robot", name=link)
        _add_object(robot, link, scene, item)
        parts[f"{FOLDER}/{link}.urdf"] = _written(robot)
    return {**parts, LIST_FILE: json.dumps(_list(scene), indent=1, allow_nan=False) + "\n"}


def object_links(scene: Scene) -> tuple[str, ...]:
    """What the objects' links are called: their ids, as far as file names and ROS can have them."""
    taken = {ROOT, *(_plain(slab.name) for slab in slabs(scene.shelf, PANEL))}
    names: list[str] = []
    for item in scene.objects:
        name = wanted = _plain(item.id)
        number = 2
        while name.lower() in taken:
            name, number = f"{wanted}_{number}", number + 1
        taken.add(name.lower())
        names.append(name)
    return tuple(names)


def position_of(item: SceneObject) -> Vector:
    """An object's centre in the shelf frame (m)."""
    return float(item.position[0]), float(item.position[1]), item.shape.height / 2.0


def _list(scene: Scene) -> Mapping[str, object]:
    rows = [
        {
            "id": item.id,
            "urdf": f"{FOLDER}/{link}.urdf",
            "target": item.id == scene.target,
            "position": position_of(item),
            "orientation": [0.0, 0.0, math.sin(item.yaw / 2.0), math.cos(item.yaw / 2.0)],
        }
        for link, item in zip(object_links(scene), scene.objects, strict=True)
    ]
    return {"format": FORMAT, "scene": scene.name, "frame": ROOT, "shelf": SHELF_FILE, "objects": rows}


def _add_shelf(robot: ET.Element, scene: Scene) -> None:
    ET.SubElement(robot, "link", name=ROOT)
    board, walls = scene.shelf.board_friction, scene.shelf.wall_friction
    for slab in slabs(scene.shelf, PANEL):
        link = _plain(slab.name)
        _add_slab(robot, link, slab, 1.0 if slab.name == "board" or board == 0.0 else walls / board)
        _fix(robot, link, slab.center, 0.0)


def _add_slab(robot: ET.Element, link: str, slab: Slab, coefficient: float) -> None:
    element = ET.SubElement(robot, "link", name=link)
    _add_friction(element, coefficient)
    _add_solid(element, "box", {"size": _text(slab.size)}, WOOD)


def _add_object(robot: ET.Element, link: str, scene: Scene, item: SceneObject) -> None:
    element = ET.SubElement(robot, "link", name=link)
    _add_friction(element, coulomb_with_board(scene, item))
    radius, height, mass = float(item.shape.radius), float(item.shape.height), float(item.mass)
    inertial = ET.SubElement(element, "inertial")
    ET.SubElement(inertial, "mass", value=repr(mass))
    across = repr(mass * (3.0 * radius**2 + height**2) / 12.0)
    zero = dict.fromkeys(("ixy", "ixz", "iyz"), "0")
    ET.SubElement(inertial, "inertia", {"ixx": across, "iyy": across, "izz": repr(mass * radius**2 / 2.0), **zero})
    figures = {"radius": repr(radius), "length": repr(height)}
    _add_solid(element, "cylinder", figures, WANTED if item.id == scene.target else PLAIN)


def _add_friction(link: ET.Element, coefficient: float) -> None:
    contact = ET.SubElement(link, "contact")
    ET.SubElement(contact, "lateral_friction", value=repr(float(coefficient)))


def _add_solid(link: ET.Element, kind: str, figures: Mapping[str, str], colour: str) -> None:
    for role in ("visual", "collision"):
        element = ET.SubElement(link, role)
        ET.SubElement(ET.SubElement(element, "geometry"), kind, dict(figures))
        if role == "visual":
            ET.SubElement(ET.SubElement(element, "material", name=f"{link.get('name')}_colour"), "color", rgba=colour)


def _fix(robot: ET.Element, link: str, at: Sequence[float], yaw: float) -> None:
    joint = ET.SubElement(robot, "joint", name=f"{link}_mount", type="fixed")
    ET.SubElement(joint, "parent", link=ROOT)
    ET.SubElement(joint, "child", link=link)
    ET.SubElement(joint, "origin", xyz=_text(at), rpy=_text((0.0, 0.0, yaw)))


def _plain(name: str) -> str:
    """A name of letters, digits and underscores."""
    return re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:60] or "unnamed"


def _text(numbers: Iterable[float]) -> str:
    return " ".join(repr(float(number)) for number in numbers)


def _written(robot: ET.Element) -> str:
    ET.indent(robot)
    return ET.tostring(robot, encoding="unicode") + "\n"
