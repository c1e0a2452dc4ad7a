"""A robot as links and joints, and its URDF text."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from phframe.core import Joint
from phframe.urdf.solids import ORIGIN, Inertia, Solid, Vector


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid part.

    Attributes:
        name: Unique in the robot.
        inertia: Of all of it.
        solids: Its covers: what collides.
    """

    name: str
    inertia: Inertia
    solids: tuple[Solid, ...] = ()


@dataclass(frozen=True, slots=True)
class Connection:
    """How one link hangs on another.

    Attributes:
        parent: Name of the link it hangs on.
        child: Name of the link it carries.
        at: Where the child's frame is at joint value 0, in the parent's (m).
        rpy: How it is turned there (rad), about the fixed axes x, y, z.
        joint: What moves; None: nothing, the links are fixed to one another.
        kind: Whether it turns or slides.
        axis: About or along which it does, in the child's frame.
        follows: Name of the joint whose value it takes over; empty: none.
    """

    parent: str
    child: str
    at: Vector
    rpy: Vector = ORIGIN
    joint: Joint | None = None
    kind: Literal["revolute", "prismatic"] = "revolute"
    axis: Vector = (0.0, 0.0, 1.0)
    follows: str = ""


def robot_urdf(name: str, links: Iterable[Link], connections: Iterable[Connection]) -> str:
    """The robot as URDF text."""
    robot = ET.Element("robot", name=name)
    for link in links:
        _add_link(robot, link)
    for connection in connections:
        _add_connection(robot, connection)
    ET.indent(robot)
    return ET.tostring(robot, encoding="unicode")


def with_frame(urdf: str, name: str, parent: str, at: Vector, rpy: Vector) -> str:
    """A URDF with a further link that is a mere frame on another; it weighs next to nothing, as engines want."""
    robot = ET.fromstring(urdf)
    speck = Inertia(1e-4, ORIGIN, (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8))
    _add_link(robot, Link(name, speck))
    _add_connection(robot, Connection(parent, name, at, rpy))
    return ET.tostring(robot, encoding="unicode")


def _add_link(robot: ET.Element, link: Link) -> None:
    element = ET.SubElement(robot, "link", name=link.name)
    inertial = ET.SubElement(element, "inertial")
    _add_origin(inertial, link.inertia.center, ORIGIN)
    ET.SubElement(inertial, "mass", value=repr(link.inertia.mass))
    keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    moments = zip(keys, link.inertia.moments, strict=True)
    ET.SubElement(inertial, "inertia", {key: repr(value) for key, value in moments})
    for number, solid in enumerate(link.solids):
        for role in ("visual", "collision"):
            name = f"{link.name} {solid.part or number} {role}"
            _add_solid(ET.SubElement(element, role, name=name), solid)


def _add_solid(element: ET.Element, solid: Solid) -> None:
    _add_origin(element, solid.at, solid.rpy)
    geometry = ET.SubElement(element, "geometry")
    if solid.kind == "box":
        ET.SubElement(geometry, "box", size=_text(solid.size))
    elif solid.kind == "cylinder":
        ET.SubElement(geometry, "cylinder", radius=repr(solid.size[0]), length=repr(solid.size[1]))
    else:
        ET.SubElement(geometry, "sphere", radius=repr(solid.size[0]))


def _add_connection(robot: ET.Element, connection: Connection) -> None:
    joint = connection.joint
    name, kind = (joint.name, connection.kind) if joint else (f"{connection.child}_mount", "fixed")
    element = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(element, "parent", link=connection.parent)
    ET.SubElement(element, "child", link=connection.child)
    _add_origin(element, connection.at, connection.rpy)
    if joint is None:
        return
    ET.SubElement(element, "axis", xyz=_text(connection.axis))
    limits = {"lower": joint.lower, "upper": joint.upper, "velocity": joint.velocity, "effort": joint.effort}
    ET.SubElement(element, "limit", {key: repr(number) for key, number in limits.items()})
    if connection.follows:
        ET.SubElement(element, "mimic", joint=connection.follows, multiplier="1", offset="0")


def _add_origin(element: ET.Element, at: Sequence[float], rpy: Sequence[float]) -> None:
    ET.SubElement(element, "origin", xyz=_text(at), rpy=_text(rpy))


def _text(numbers: Sequence[float]) -> str:
    return " ".join(repr(float(number)) for number in numbers)
