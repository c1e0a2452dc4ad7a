"""Reads a robot from URDF text, as others write it: missing limits, mimic and continuous joints, meshes of packages."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from math import hypot
from pathlib import Path
from typing import Literal, cast

from phframe.core import ArmError, Joint
from phframe.core.names import name_fault, name_shown
from phframe.urdf.convex_hull import ConvexHull, read_hull
from phframe.urdf.mesh_files import find_mesh
from phframe.urdf.model import CollisionGeometry, Color, Link, MeshFile, Mimic, Robot, RobotJoint, Visual
from phframe.urdf.solids import ORIGIN, Inertia, Solid, Vector
from phframe.yaml.wording import abridged, shown

KINDS = ("fixed", "revolute", "continuous", "prismatic")
TURN = 3.141592653589793
"""Either way, of a joint that turns for ever (rad)."""
MOST_LINKS = 1000
"""Of a robot."""
MOST = 1e20
"""Of any number, either way: products of three are numbers, too. Limits of 1e16 that stand for none are in use."""
MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
Colors = dict[str, Color | None]


def read_robot(text: str, folder: Path | None = None) -> Robot:
    """The robot in a URDF text. Meshes that collide are replaced by their convex hulls; those of visuals stay unread.

    Args:
        text: The URDF.
        folder: The URDF's, where meshes are looked for; None: it is a mere text, with absolute paths.

    Raises:
        ArmError: If it is no URDF, its links do not make one tree, or a mesh that collides cannot be had.
        NotInstalledError: If what reads a mesh of this format is not installed.
    """
    try:
        root = ET.fromstring(text)
    except (ET.ParseError, ValueError) as error:  # ValueError: half of a character
        raise ArmError(f"the URDF is not XML: {error}") from None
    if root.tag != "robot":
        raise ArmError(f"the URDF begins with <{abridged(root.tag)}>, not with <robot>")
    if len(root.findall("link")) > MOST_LINKS:
        raise ArmError(f"the URDF has more than {MOST_LINKS} links; that is no arm")
    colors: Colors = {material.get("name", ""): _color(material) for material in root.findall("material")}
    links = [_link(element, folder, colors) for element in root.findall("link")]
    return Robot.of(root.get("name") or "robot", links, map(_joint, root.findall("joint")))


def _link(element: ET.Element, folder: Path | None, colors: Colors) -> Link:
    name = _name(element, "a link")
    collision = (_collision(each, name, folder) for each in element.findall("collision"))
    visuals = (_visual(each, name, folder, colors) for each in element.findall("visual"))
    return Link(
        name,
        _inertia(element.find("inertial"), name),
        tuple(shape for shape in collision if shape is not None),
        tuple(visual for visual in visuals if visual is not None),
    )


def _inertia(element: ET.Element | None, link: str) -> Inertia | None:
    if element is None:
        return None
    owner, moments = f"the inertia of link {shown(link)}", element.find("inertia")
    at, rpy = _origin(element)
    numbers = [0.0 if moments is None else _given(moments, key, owner) for key in MOMENTS]
    xx, xy, xz, yy, yz, zz = numbers
    mass = _number(element.find("mass"), "value", owner)
    if mass < 0.0 or min(xx, yy, zz) < 0.0:
        raise ArmError(f"{owner} of the URDF has a mass or a moment below 0")
    inertia = Inertia(mass, ORIGIN, (xx, xy, xz, yy, yz, zz))
    return inertia.moved(at, rpy) if any(rpy) else Inertia(inertia.mass, at, inertia.moments)


def _collision(element: ET.Element, link: str, folder: Path | None) -> CollisionGeometry | None:
    shape = _shape(element, link, "collision")
    if not isinstance(shape, MeshFile):
        return shape
    path = find_mesh(shape.file, folder)
    vertices, triangles = read_hull(path, shape.scale)
    name, part = _names(element, link, "collision")
    return ConvexHull(str(path), shape.scale, vertices, triangles, shape.at, shape.rpy, part, name)


def _visual(element: ET.Element, link: str, folder: Path | None, colors: Colors) -> Visual | None:
    shape, material = _shape(element, link, "visual"), element.find("material")
    color = None if material is None else _color(material) or colors.get(material.get("name", ""))
    if isinstance(shape, MeshFile):
        shape = MeshFile(_found(shape.file, folder), shape.scale, shape.at, shape.rpy)
    return None if shape is None else Visual(shape, color)


def _found(file: str, folder: Path | None) -> str:
    """The path of a file that need not be there."""
    try:
        return str(find_mesh(file, folder))
    except ArmError:
        return file


def _shape(element: ET.Element, link: str, role: str) -> Solid | MeshFile | None:
    """None where there is no geometry.

    Raises:
        ArmError: If it is of a kind that is not known.
    """
    (at, rpy), (name, part) = _origin(element), _names(element, link, role)
    geometry = element.find("geometry")
    shape = None if geometry is None else next(iter(geometry), None)
    owner = f"the {role} geometry of link {shown(link)}"
    if shape is None:
        return None
    match shape.tag:
        case "box":
            box = _sizes(owner, *_vector(_attribute(shape, "size", owner), owner))
            return Solid("box", box, at, rpy, part, name)
        case "cylinder":
            size = _sizes(owner, _number(shape, "radius", owner), _number(shape, "length", owner))
            return Solid("cylinder", size, at, rpy, part, name)
        case "sphere":
            return Solid("sphere", _sizes(owner, _number(shape, "radius", owner)), at, rpy, part, name)
        case "mesh":
            scale = _vector(shape.get("scale", "1 1 1"), owner)
            return MeshFile(_attribute(shape, "filename", owner), scale, at, rpy)
    raise ArmError(f"{owner} in the URDF is a {shown(shape.tag)}; there is: box, cylinder, sphere, mesh")


def _sizes(owner: str, *sizes: float) -> tuple[float, ...]:
    if min(sizes) <= 0.0:
        raise ArmError(f"{owner} of the URDF has a size of {min(sizes):g} m; one above 0 is needed")
    return sizes


def _names(element: ET.Element, link: str, role: str) -> tuple[str, str]:
    """Name of a shape without its role, and without its link."""
    name = element.get("name", "").removesuffix(role).strip()
    return name, name.removeprefix(link).strip()


def _color(material: ET.Element) -> Color | None:
    element = material.find("color")
    numbers = [] if element is None else _numbers(element.get("rgba", ""), "a colour")
    return cast(Color, tuple(numbers)) if len(numbers) == 4 else None


def _joint(element: ET.Element) -> RobotJoint:
    name, kind = _name(element, "a joint"), element.get("type", "")
    if kind not in KINDS:
        raise ArmError(
            f"joint {shown(name)} of the URDF is {shown(kind)}; an arm has joints that are {', '.join(KINDS)}"
        )
    owner, (at, rpy) = f"joint {shown(name)}", _origin(element)
    parent, child = (_attribute(element.find(tag), "link", owner) for tag in ("parent", "child"))
    if kind == "fixed":
        return RobotJoint(parent, child, at, rpy, fixed_name=name)
    dynamics = element.find("dynamics")
    return RobotJoint(
        parent,
        child,
        at,
        rpy,
        _limits(name, kind, element.find("limit")),
        cast(Literal["revolute", "continuous", "prismatic"], kind),
        _axis(element.find("axis"), owner),
        _mimic(element.find("mimic"), owner),
        _given(dynamics, "damping", owner),
        _given(dynamics, "friction", owner),
    )


def _axis(element: ET.Element | None, owner: str) -> Vector:
    x, y, z = (1.0, 0.0, 0.0) if element is None else _vector(element.get("xyz", "1 0 0"), owner)
    length = hypot(x, y, z)
    if length == 0.0:
        raise ArmError(f"{owner} of the URDF has an axis of no length")
    return x / length, y / length, z / length


def _mimic(element: ET.Element | None, owner: str) -> Mimic | None:
    if element is None:
        return None
    leader = _attribute(element, "joint", f"the mimic of {owner}")
    return Mimic(leader, _given(element, "multiplier", owner, 1.0), _given(element, "offset", owner))


def _limits(name: str, kind: str, limit: ET.Element | None) -> Joint:
    """What is not given is 0, as the standard has it: joints that are not driven may do without."""
    lower, upper, velocity, effort = (
        _given(limit, key, f"joint {shown(name)}") for key in ("lower", "upper", "velocity", "effort")
    )
    return Joint(name, *((-TURN, TURN) if kind == "continuous" else (lower, upper)), velocity=velocity, effort=effort)


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


def _name(element: ET.Element, owner: str) -> str:
    name = _attribute(element, "name", owner)
    if fault := name_fault(name):
        raise ArmError(f"{owner} of the URDF has the name {name_shown(name)}, which {fault}")
    return name


def _given(element: ET.Element | None, key: str, owner: str, otherwise: float = 0.0) -> float:
    value = None if element is None else element.get(key)
    return otherwise if value is None else _finite(value, owner)


def _number(element: ET.Element | None, key: str, owner: str) -> float:
    return _finite(_attribute(element, key, owner), owner)


def _vector(text: str, owner: str) -> Vector:
    numbers = _numbers(text, owner)
    if len(numbers) != 3:
        raise ArmError(f"{owner} of the URDF has {shown(text)} where three numbers are needed")
    return numbers[0], numbers[1], numbers[2]


def _numbers(text: str, owner: str) -> list[float]:
    return [_finite(word, owner) for word in text.split()]


def _finite(text: str, owner: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise ArmError(f"{owner} of the URDF has {shown(text)} where a number is needed") from None
    if not abs(number) <= MOST:
        raise ArmError(f"{owner} of the URDF has {shown(text)} where a finite number is needed, at most {MOST:g}")
    return number
