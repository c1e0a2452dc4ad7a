"""A scene as URDF: whole with everything fixed, or in parts that can be put into a simulator one by one.

URDF knows no free bodies that all readers agree on, and no friction. So a whole scene is a still picture, for planning
scenes and collision checks; the parts are for simulators, with a list of where they belong. The friction in them is
PyBullet's, which multiplies the coefficients of the two bodies: the board has 1, so that the objects' own remain.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping

from phframe.core import Scene, SceneObject, coulomb_with_board
from phframe.geometry.slabs import BOARD, PANEL, slabs
from phframe.scenes.shapes import solid_of
from phframe.urdf.model import Color, Link, Robot, RobotJoint, Visual
from phframe.urdf.solids import Solid, Vector, of_solids
from phframe.urdf.writer import robot_urdf

FORMAT = 1
"""Of the list of parts."""
ROOT = "shelf"
"""The link whose frame is the shelf frame."""
SHELF_FILE, LIST_FILE, FOLDER = "shelf.urdf", "poses.json", "objects"
WOOD: Color = (0.72, 0.55, 0.38, 1.0)
PLAIN: Color = (0.35, 0.45, 0.6, 1.0)
WANTED: Color = (0.85, 0.2, 0.15, 1.0)


def scene_to_urdf(scene: Scene) -> str:
    """The shelf and all objects as one robot in which every link is fixed to ``shelf``."""
    links, joints = _shelf(scene)
    for link, item in zip(object_links(scene), scene.objects, strict=True):
        links.append(_object(link, scene, item))
        joints.append(RobotJoint(ROOT, link, position_of(item), (0.0, 0.0, float(item.yaw))))
    return _written(Robot.of(_plain(scene.name), links, joints))


def scene_parts(scene: Scene) -> dict[str, str]:
    """The shelf, each object and the list of their poses: texts by the path of their file."""
    parts = {SHELF_FILE: _written(Robot.of(ROOT, *_shelf(scene)))}
    for link, item in zip(object_links(scene), scene.objects, strict=True):
        parts[f"{FOLDER}/{link}.urdf"] = _written(Robot.of(link, [_object(link, scene, item)]))
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


def _shelf(scene: Scene) -> tuple[list[Link], list[RobotJoint]]:
    links, joints = [Link(ROOT)], []
    board, walls = scene.shelf.board_friction, scene.shelf.wall_friction
    for slab in slabs(scene.shelf, PANEL):
        link, box = _plain(slab.name), Solid("box", slab.size)
        coefficient = 1.0 if slab.name == BOARD or board == 0.0 else walls / board
        links.append(Link(link, None, (box,), (Visual(box, WOOD),), coefficient))
        joints.append(RobotJoint(ROOT, link, slab.center))
    return links, joints


def _object(link: str, scene: Scene, item: SceneObject) -> Link:
    solid = solid_of(item.shape)
    color = WANTED if item.id == scene.target else PLAIN
    inertia = of_solids(float(item.mass), [solid])
    return Link.of_solids(link, inertia, [solid], color, friction=coulomb_with_board(scene, item))


def _plain(name: str) -> str:
    """A name of letters, digits and underscores."""
    return re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:60] or "unnamed"


def _written(robot: Robot) -> str:
    return robot_urdf(robot) + "\n"
