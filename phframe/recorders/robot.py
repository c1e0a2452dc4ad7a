"""A robot as its URDF says: the links as bodies to draw, and where they are for given joint values.

Rerun has a URDF reader of its own, which wants files, draws what collides too and moves no joint that follows another;
and pictures by other means need the same. So the text is read here.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from phframe.core import ArmError, FloatArray, LinkMesh
from phframe.recorders import palette
from phframe.recorders.bodies import Body, Piece, Primitive, Surface


@dataclass(frozen=True, slots=True, eq=False)
class Hinge:
    """How one link hangs on another.

    Attributes:
        parent: Link.
        child: Link.
        joint: Name of the joint.
        origin: ``(4, 4)`` of the child in the frame of the parent, at joint value 0.
        kind: As in URDF: fixed, revolute, continuous or prismatic.
        axis: ``(3,)`` about or along which it moves.
        follows: The joint whose value it takes over, times a number plus a number; None: none.
    """

    parent: str
    child: str
    joint: str
    origin: FloatArray
    kind: str
    axis: FloatArray
    follows: tuple[str, float, float] | None

    def placed(self, values: Mapping[str, FloatArray]) -> FloatArray:
        """``(m, 4, 4)`` of the child in the frame of the parent for joint values ``(m,)``; ``m`` is 1 where none count."""
        value = self._value(values)
        if value is None or self.kind == "fixed":
            return self.origin[None]
        moved = np.tile(np.eye(4), (len(value), 1, 1))
        if self.kind == "prismatic":
            moved[:, :3, 3] = value[:, None] * self.axis
        else:
            moved[:, :3, :3] = Rotation.from_rotvec(value[:, None] * self.axis).as_matrix()
        return np.asarray(self.origin @ moved)

    def _value(self, values: Mapping[str, FloatArray]) -> FloatArray | None:
        if self.joint in values:
            return values[self.joint]
        if self.follows is not None and self.follows[0] in values:
            leader, factor, offset = self.follows
            return factor * values[leader] + offset
        return None


@dataclass(frozen=True, slots=True)
class Robot:
    """Links and how they hang together.

    Attributes:
        bodies: The links of which anything is to be seen.
        hinges: Parents come before children.
        root: The link that hangs on nothing.
    """

    bodies: tuple[Body, ...]
    hinges: tuple[Hinge, ...]
    root: str

    def poses(self, base: FloatArray, values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """Pose ``(m, 7)`` of every link; ``m`` is 1 for those that no given joint moves.

        Args:
            base: Pose ``(7,)`` of the root, in the frame in which the links' are wanted.
            values: By joint, each ``(m,)``; the others are at 0.
        """
        placed: dict[str, FloatArray] = {self.root: _as_matrix(base)[None]}
        for hinge in self.hinges:
            placed[hinge.child] = placed[hinge.parent] @ hinge.placed(values)
        return {link: _as_pose(matrices) for link, matrices in placed.items()}


def read_robot(urdf: str, meshes: Iterable[LinkMesh] = (), bright: Iterable[str] = ()) -> Robot:
    """The robot in a URDF text.

    Args:
        urdf: The text.
        meshes: Drawn instead of the links' primitives.
        bright: Links in the colour of fingers.

    Raises:
        ArmError: If the text cannot be read.
    """
    try:
        return _read(ET.fromstring(urdf), tuple(meshes), frozenset(bright))
    except (ET.ParseError, ValueError, KeyError) as error:
        raise ArmError(f"the URDF of the arm cannot be drawn: {error}") from None


def _read(root: ET.Element, meshes: tuple[LinkMesh, ...], bright: frozenset[str]) -> Robot:
    links = {link.attrib["name"]: link for link in root.findall("link")}
    hinges = {hinge.child: hinge for hinge in map(_hinge, root.findall("joint"))}
    (top,) = [name for name in links if name not in hinges]
    if strangers := {mesh.link for mesh in meshes} - set(links):
        raise ValueError(f"there are meshes for {', '.join(sorted(strangers))}, which it has no link for")
    bodies = (_body(name, link, meshes, bright) for name, link in links.items())
    return Robot(tuple(body for body in bodies if body.pieces), tuple(_sorted(hinges, top)), top)


def _sorted(hinges: Mapping[str, Hinge], top: str) -> Iterator[Hinge]:
    """Parents first."""
    parents = [top]
    while parents:
        parent = parents.pop(0)
        for hinge in hinges.values():
            if hinge.parent == parent:
                yield hinge
                parents.append(hinge.child)


def _hinge(element: ET.Element) -> Hinge:
    parent, child = (_child(element, tag).attrib["link"] for tag in ("parent", "child"))
    axis, mimic = element.find("axis"), element.find("mimic")
    along = np.array([1.0, 0.0, 0.0] if axis is None else _numbers(axis.attrib["xyz"]))
    follows = None
    if mimic is not None:
        follows = mimic.attrib["joint"], float(mimic.get("multiplier", 1.0)), float(mimic.get("offset", 0.0))
    unit = along / np.linalg.norm(along)
    return Hinge(parent, child, element.attrib["name"], _origin(element), element.attrib["type"], unit, follows)


def _body(name: str, link: ET.Element, meshes: tuple[LinkMesh, ...], bright: frozenset[str]) -> Body:
    """What a link looks like: its meshes, else its visuals, else, where those are files, what collides."""
    own = [mesh for mesh in meshes if mesh.link == name]
    if own:
        return Body(name, tuple(_mesh_piece(number, mesh) for number, mesh in enumerate(own)))
    elements = link.findall("visual")
    shapes = [_primitive(element) for element in elements]
    if None in shapes or not shapes:
        elements = link.findall("collision")
        shapes = [_primitive(element) for element in elements]
    color = palette.FINGER if name in bright else palette.LINK
    return Body(name, tuple(Piece(str(i), shape, color) for i, shape in enumerate(shapes) if shape is not None))


def _mesh_piece(number: int, mesh: LinkMesh) -> Piece:
    red, green, blue = (round(255 * channel) for channel in mesh.color)
    return Piece(str(number), Surface(mesh.vertices, mesh.triangles), (red, green, blue, 255))


def _primitive(element: ET.Element) -> Primitive | None:
    """A box, cylinder or sphere; None for anything else."""
    shape, pose = next(iter(_child(element, "geometry")), None), _as_pose(_origin(element)[None])[0]
    match None if shape is None else (shape.tag, shape.attrib):
        case "box", given:
            return Primitive("box", tuple(_numbers(given["size"])), pose)
        case "cylinder", given:
            return Primitive("cylinder", (float(given["radius"]), float(given["length"])), pose)
        case "sphere", given:
            return Primitive("sphere", (float(given["radius"]),), pose)
        case _:
            return None


def _origin(element: ET.Element) -> FloatArray:
    """``(4, 4)``."""
    placed, origin = np.eye(4), element.find("origin")
    if origin is not None:
        placed[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
        placed[:3, :3] = Rotation.from_euler("xyz", _numbers(origin.get("rpy", "0 0 0"))).as_matrix()
    return placed


def _as_matrix(pose: FloatArray) -> FloatArray:
    """``(4, 4)``."""
    matrix = np.eye(4)
    matrix[:3, 3], matrix[:3, :3] = pose[:3], Rotation.from_quat(pose[[4, 5, 6, 3]]).as_matrix()
    return matrix


def _as_pose(matrices: FloatArray) -> FloatArray:
    """Poses ``(m, 7)`` of matrices ``(m, 4, 4)``."""
    quaternions = Rotation.from_matrix(matrices[:, :3, :3]).as_quat()
    return np.concatenate([matrices[:, :3, 3], quaternions[:, [3, 0, 1, 2]]], axis=1)


def _child(element: ET.Element, tag: str) -> ET.Element:
    found = element.find(tag)
    if found is None:
        raise ValueError(f"{element.tag} {element.get('name', '')!r} has no <{tag}>")
    return found


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.split()]
