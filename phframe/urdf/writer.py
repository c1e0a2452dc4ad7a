"""Writes a robot as URDF text."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from phframe.urdf.model import CollisionGeometry, Link, MeshFile, Robot, RobotJoint, Visual
from phframe.urdf.solids import ORIGIN, Inertia, Solid

MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def robot_urdf(robot: Robot) -> str:
    """The robot as URDF text; meshes are named by their files."""
    root = ET.Element("robot", name=robot.name)
    taken: set[str] = set()
    for link in robot.links.values():
        _add_link(root, link, taken)
    for joint in robot.parent_joints.values():
        _add_joint(root, joint)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode")


def _add_link(root: ET.Element, link: Link, taken: set[str]) -> None:
    element = ET.SubElement(root, "link", name=link.name)
    if link.friction is not None:
        ET.SubElement(ET.SubElement(element, "contact"), "lateral_friction", value=repr(float(link.friction)))
    if link.inertia is not None:
        _add_inertia(element, link.inertia)
    for number, visual in enumerate(link.visuals):
        name = _free_name(link.name, visual.shape, number, "visual", taken)
        _add_visual(ET.SubElement(element, "visual", name=name), visual, link.name)
    for number, shape in enumerate(link.collision_geometry):
        name = _free_name(link.name, shape, number, "collision", taken)
        _add_shape(ET.SubElement(element, "collision", name=name), shape)


def _free_name(link: str, shape: CollisionGeometry | MeshFile, number: int, role: str, taken: set[str]) -> str:
    """Of an element: its own, if that is unique in the robot, as engines want it."""
    own = f"{link} {getattr(shape, 'part', '') or number}"
    wanted = (getattr(shape, "name", "") or own, own, f"{own} {number}", *(f"{own} {number}.{n}" for n in range(99)))
    name = next(f"{each} {role}" for each in wanted if f"{each} {role}" not in taken)
    taken.add(name)
    return name


def _add_inertia(element: ET.Element, inertia: Inertia) -> None:
    inertial = ET.SubElement(element, "inertial")
    _add_origin(inertial, inertia.center, ORIGIN)
    ET.SubElement(inertial, "mass", value=repr(float(inertia.mass)))
    moments = zip(MOMENTS, inertia.moments, strict=True)
    ET.SubElement(inertial, "inertia", {key: repr(float(value)) for key, value in moments})


def _add_visual(element: ET.Element, visual: Visual, link: str) -> None:
    _add_shape(element, visual.shape)
    if visual.color is not None:
        material = ET.SubElement(element, "material", name=f"{link}_color_{'_'.join(f'{c:g}' for c in visual.color)}")
        ET.SubElement(material, "color", rgba=_text(visual.color))


def _add_shape(element: ET.Element, shape: CollisionGeometry | MeshFile) -> None:
    _add_origin(element, shape.at, shape.rpy)
    geometry = ET.SubElement(element, "geometry")
    if not isinstance(shape, Solid):
        ET.SubElement(geometry, "mesh", filename=shape.file, scale=_text(shape.scale))
    elif shape.kind == "box":
        ET.SubElement(geometry, "box", size=_text(shape.size))
    elif shape.kind == "cylinder":
        ET.SubElement(geometry, "cylinder", radius=repr(shape.size[0]), length=repr(shape.size[1]))
    else:
        ET.SubElement(geometry, "sphere", radius=repr(shape.size[0]))


def _add_joint(root: ET.Element, hung: RobotJoint) -> None:
    joint = hung.joint
    element = ET.SubElement(root, "joint", name=hung.name, type=hung.kind if joint else "fixed")
    ET.SubElement(element, "parent", link=hung.parent)
    ET.SubElement(element, "child", link=hung.child)
    _add_origin(element, hung.at, hung.rpy)
    if joint is None:
        return
    ET.SubElement(element, "axis", xyz=_text(hung.axis))
    limits = {"lower": joint.lower, "upper": joint.upper, "velocity": joint.velocity, "effort": joint.effort}
    ET.SubElement(element, "limit", {key: repr(float(number)) for key, number in limits.items()})
    if hung.damping or hung.friction:
        ET.SubElement(element, "dynamics", damping=repr(hung.damping), friction=repr(hung.friction))
    if mimic := hung.mimic:
        numbers = {"multiplier": repr(float(mimic.multiplier)), "offset": repr(float(mimic.offset))}
        ET.SubElement(element, "mimic", {"joint": mimic.joint, **numbers})


def _add_origin(element: ET.Element, at: Sequence[float], rpy: Sequence[float]) -> None:
    ET.SubElement(element, "origin", xyz=_text(at), rpy=_text(rpy))


def _text(numbers: Sequence[float]) -> str:
    return " ".join(repr(float(number)) for number in numbers)
