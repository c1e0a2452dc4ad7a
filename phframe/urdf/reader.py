"""Reads of a URDF text what an arm needs: its covers, how its links hang together, and the limits of its joints."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Literal

from phframe.core import ArmError, Joint
from phframe.urdf.model import Connection
from phframe.urdf.solids import ORIGIN, Solid, Vector

KINDS = ("fixed", "revolute", "continuous", "prismatic")
TURN = 3.141592653589793
"""Either way, of a joint that turns for ever (rad)."""


@dataclass(frozen=True, slots=True)
class Robot:
    """A URDF as far as an arm needs it.

    Attributes:
        covers: Solids that collide, by link.
        connections: What each link but the root hangs on, by that link.
        meshes: Links among whose covers is a mesh, of which nothing can be said.
    """

    covers: Mapping[str, tuple[Solid, ...]]
    connections: Mapping[str, Connection]
    meshes: tuple[str, ...] = ()

    def joint(self, name: str) -> Connection:
        """The connection whose joint bears a name.

        Raises:
            ArmError: If no joint that moves is called so.
        """
        moving = {c.joint.name: c for c in self.connections.values() if c.joint}
        if name not in moving:
            raise ArmError(f"the URDF has no moving joint {name!r}; there is: {', '.join(sorted(moving)) or 'none'}")
        return moving[name]


def read_robot(text: str) -> Robot:
    """The robot in a URDF text.

    Raises:
        ArmError: If it is no URDF, or its links do not make one tree.
    """
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise ArmError(f"the URDF is not XML: {error}") from None
    if root.tag != "robot":
        raise ArmError(f"the URDF begins with <{root.tag}>, not with <robot>")
    covers = {_attribute(link, "name", "a link"): _covers(link) for link in root.findall("link")}
    connections = [_connection(joint) for joint in root.findall("joint")]
    meshes = tuple(
        link.get("name", "") for link in root.findall("link") if link.find("collision/geometry/mesh") is not None
    )
    robot = Robot(covers, {connection.child: connection for connection in connections}, meshes)
    _check_tree(robot, connections)
    return robot


def _check_tree(robot: Robot, connections: list[Connection]) -> None:
    for connection in connections:
        for link in (connection.parent, connection.child):
            if link not in robot.covers:
                raise ArmError(f"a joint of the URDF names the link {link!r}, which does not exist")
    roots = [link for link in robot.covers if link not in robot.connections]
    if len(roots) != 1 or len(connections) != len(robot.connections):
        raise ArmError(f"the links of the URDF must make one tree; without a parent: {', '.join(roots) or 'none'}")


def _covers(link: ET.Element) -> tuple[Solid, ...]:
    return tuple(solid for element in link.findall("collision") if (solid := _solid(link, element)) is not None)


def _solid(link: ET.Element, element: ET.Element) -> Solid | None:
    """A collision shape; None for a mesh, of which nothing can be said."""
    name, (at, rpy) = link.get("name", ""), _origin(element)
    part = element.get("name", "").removeprefix(name).removesuffix("collision").strip()
    shape = next(iter(element.find("geometry") or ()), None)
    match shape.tag if shape is not None else None:
        case "box":
            return Solid("box", _vector(_attribute(shape, "size", name), name), at, rpy, part)
        case "cylinder":
            return Solid("cylinder", (_number(shape, "radius", name), _number(shape, "length", name)), at, rpy, part)
        case "sphere":
            return Solid("sphere", (_number(shape, "radius", name),), at, rpy, part)
        case _:
            return None


def _connection(element: ET.Element) -> Connection:
    name, kind = _attribute(element, "name", "a joint"), element.get("type", "")
    if kind not in KINDS:
        raise ArmError(f"joint {name!r} of the URDF is {kind!r}; an arm has joints that are {', '.join(KINDS)}")
    parent, child = (_attribute(element.find(tag), "link", f"joint {name!r}") for tag in ("parent", "child"))
    at, rpy = _origin(element)
    if kind == "fixed":
        return Connection(parent, child, at, rpy)
    axis_element, mimic = element.find("axis"), element.find("mimic")
    axis = (1.0, 0.0, 0.0) if axis_element is None else _vector(axis_element.get("xyz", "1 0 0"), name)
    moves: Literal["revolute", "prismatic"] = "prismatic" if kind == "prismatic" else "revolute"
    follows = "" if mimic is None else mimic.get("joint", "")
    return Connection(parent, child, at, rpy, _joint(name, kind, element.find("limit")), moves, axis, follows)


def _joint(name: str, kind: str, limit: ET.Element | None) -> Joint:
    what = f"joint {name!r}"
    if limit is None:
        raise ArmError(f"{what} of the URDF has no <limit>; lower, upper, velocity and effort are needed")
    bounds = (-TURN, TURN) if kind == "continuous" else (_number(limit, "lower", what), _number(limit, "upper", what))
    return Joint(name, *bounds, velocity=_number(limit, "velocity", what), effort=_number(limit, "effort", what))


def _origin(element: ET.Element) -> tuple[Vector, Vector]:
    origin = element.find("origin")
    if origin is None:
        return ORIGIN, ORIGIN
    return _vector(origin.get("xyz", "0 0 0"), "an origin"), _vector(origin.get("rpy", "0 0 0"), "an origin")


def _attribute(element: ET.Element | None, key: str, owner: str) -> str:
    value = "" if element is None else element.get(key, "")
    if not value:
        raise ArmError(f"{owner} of the URDF has no {key}")
    return value


def _number(element: ET.Element | None, key: str, owner: str) -> float:
    return _finite(_attribute(element, key, owner), owner)


def _vector(text: str, owner: str) -> Vector:
    numbers = [_finite(word, owner) for word in text.split()]
    if len(numbers) != 3:
        raise ArmError(f"{owner} of the URDF has {text!r} where three numbers are needed")
    return numbers[0], numbers[1], numbers[2]


def _finite(text: str, owner: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise ArmError(f"{owner} of the URDF has {text!r} where a number is needed") from None
    if not isfinite(number):
        raise ArmError(f"{owner} of the URDF has {text!r} where a finite number is needed")
    return number
