"""A scene as MJCF, MuJoCo's format: text that needs nothing but itself.

The world frame is the shelf frame. Each object is a body of its id on a free joint. Friction: MuJoCo takes that of the
geom of higher priority, so walls count before objects and objects before the board; between two objects the greater.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence

from phframe.core import Scene, SceneObject, Shelf, coulomb_with_board
from phframe.geometry.slabs import PANEL, slabs
from phframe.scenes.shapes import geom_of

TARGET_KEY = "target"
"""Of the custom text that names the target's body."""
MOUNT_PREFIX = "mount/"
"""Of the sites that say where arms stand."""
ARM_PREFIX = "arm/"
"""Of the names of an arm that is put into the text."""
CONTACT = {"condim": "4", "solref": "0.02 1"}
"""Contacts with friction against turning on the spot, stiff and without rebound."""
TURNING, ROLLING = 0.005, 0.0005
"""Friction against turning on the spot and against rolling (m)."""
WOOD, GLASS, PLAIN, WANTED = "0.72 0.55 0.38 1", "0.72 0.55 0.38 0.3", "0.35 0.45 0.6 1", "0.85 0.2 0.15 1"
"""Colours of board and back wall, of what would hide the objects, of objects, of the target."""


def scene_to_mjcf(scene: Scene) -> str:
    """The text of an MJCF file of a scene, without an arm."""
    root = ET.Element("mujoco", model=scene.name)
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    ET.SubElement(root, "option", timestep="0.002", integrator="implicitfast", cone="elliptic", impratio="3")
    names = body_names(scene)
    ET.SubElement(ET.SubElement(root, "custom"), "text", name=TARGET_KEY, data=names[scene.target_index])
    world = ET.SubElement(root, "worldbody")
    ET.SubElement(world, "light", pos=f"-0.5 {scene.shelf.width / 2!r} 1.5", dir="0.3 0 -1")
    _add_shelf(world, scene.shelf)
    for name, base_pose in scene.base_poses.items():
        half = base_pose.yaw / 2.0
        turned = (math.cos(half), 0.0, 0.0, math.sin(half))
        ET.SubElement(
            world,
            "site",
            name=MOUNT_PREFIX + name,
            pos=_text((base_pose.x, base_pose.y, base_pose.z)),
            quat=_text(turned),
        )
    for name, item in zip(names, scene.objects, strict=True):
        _add_object(world, name, item, coulomb_with_board(scene, item), WANTED if item.id == scene.target else PLAIN)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def body_names(scene: Scene) -> tuple[str, ...]:
    """What the objects' bodies are called: their ids, but for those that MuJoCo or the file have for something else."""
    taken = {"world", "shelf", *(slab.name for slab in slabs(scene.shelf, PANEL))}
    names: list[str] = []
    for wanted in scene.ids:
        name = wanted
        while name in taken or name.startswith(ARM_PREFIX) or (name != wanted and name in scene.ids):
            name = f"object {name}"
        taken.add(name)
        names.append(name)
    return tuple(names)


def _add_shelf(world: ET.Element, shelf: Shelf) -> None:
    body = ET.SubElement(world, "body", name="shelf")
    for slab in slabs(shelf, PANEL):
        board = slab.name == "board"
        coefficient = shelf.board_friction if board else shelf.wall_friction
        ET.SubElement(
            body,
            "geom",
            {
                "name": slab.name,
                "type": "box",
                "pos": _text(slab.center),
                "size": _text([length / 2.0 for length in slab.size]),
                "friction": _text((coefficient, TURNING, ROLLING)),
                "priority": "0" if board else "2",
                "rgba": WOOD if slab.name in ("board", "back wall") else GLASS,
                **CONTACT,
            },
        )


def _add_object(world: ET.Element, name: str, item: SceneObject, coefficient: float, colour: str) -> None:
    half = item.shape.height / 2.0
    kind, size = geom_of(item.shape)
    turned = (math.cos(item.yaw / 2.0), 0.0, 0.0, math.sin(item.yaw / 2.0))
    body = ET.SubElement(world, "body", name=name, pos=_text((*item.position, half)), quat=_text(turned))
    ET.SubElement(body, "freejoint", name=name)
    ET.SubElement(
        body,
        "geom",
        {
            "name": name,
            "type": kind,
            "size": _text(size),
            "mass": _text((item.mass,)),
            "friction": _text((coefficient, TURNING, ROLLING)),
            "priority": "1",
            "rgba": colour,
            **CONTACT,
        },
    )


def _text(numbers: Sequence[float] | Iterable[float]) -> str:
    """Numbers in the fewest digits that give the same numbers again."""
    return " ".join(repr(float(number)) for number in numbers)
