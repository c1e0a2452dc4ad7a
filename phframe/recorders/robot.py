"""A robot to be drawn: its links as bodies, and where they are for given joint values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from phframe.core import ArmError, FloatArray, LinkMesh
from phframe.recorders import palette
from phframe.recorders.bodies import Body, Piece, Primitive, Surface
from phframe.urdf.model import CollisionGeometry, Link, MeshFile, Robot, RobotJoint
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import Solid, rotation


@dataclass(frozen=True)
class DrawnRobot:
    """Links and how they hang together.

    Attributes:
        bodies: The links of which anything is to be seen.
        robot: The robot.
    """

    bodies: tuple[Body, ...]
    robot: Robot

    def poses(self, base: FloatArray, values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """Pose ``(m, 7)`` of every link; ``m`` is 1 for those that no given joint moves.

        Args:
            base: Pose ``(7,)`` of the root, in the frame in which the links' are wanted.
            values: By joint, each ``(m,)``; the others are at 0.
        """
        placed: dict[str, FloatArray] = {self.robot.root: _as_matrix(base)[None]}
        for joint in self.robot.from_root:
            placed[joint.child] = placed[joint.parent] @ _placements(joint, values)
        return {link: _as_pose(matrices) for link, matrices in placed.items()}


def drawn_robot(urdf: str, meshes: Iterable[LinkMesh] = (), bright: Iterable[str] = ()) -> DrawnRobot:
    """The robot in a URDF text.

    Args:
        urdf: The text.
        meshes: Drawn instead of the links' primitives.
        bright: Links in the colour of fingers.

    Raises:
        ArmError: If the text cannot be read, or there are meshes for a link that it has not.
    """
    robot, seen, fingers = read_robot(urdf), tuple(meshes), frozenset(bright)
    if strangers := {mesh.link for mesh in seen} - set(robot.links):
        raise ArmError(f"there are meshes for {', '.join(sorted(strangers))}, which the URDF has no link for")
    bodies = [
        _body(link, seen, palette.FINGER if link.name in fingers else palette.LINK) for link in robot.links.values()
    ]
    return DrawnRobot(tuple(body for body in bodies if body.pieces), robot)


def _placements(joint: RobotJoint, values: Mapping[str, FloatArray]) -> FloatArray:
    """``(m, 4, 4)`` of the child in the frame of the parent for joint values ``(m,)``; ``m`` is 1 where none count."""
    given = values.get(joint.name)
    if given is None and joint.mimic is not None and joint.mimic.joint in values:
        given = joint.mimic.multiplier * values[joint.mimic.joint] + joint.mimic.offset
    if given is None or joint.joint is None:
        return joint.placement()[None]
    moved = np.tile(np.eye(4), (len(given), 1, 1))
    along = given[:, None] * np.array(joint.axis)
    if joint.kind == "prismatic":
        moved[:, :3, 3] = along
    else:
        moved[:, :3, :3] = Rotation.from_rotvec(along).as_matrix()
    return np.asarray(joint.placement() @ moved)


def _body(link: Link, meshes: tuple[LinkMesh, ...], color: palette.Color) -> Body:
    """What a link looks like: its meshes, else its visuals, else, where those are files, what collides."""
    own = [mesh for mesh in meshes if mesh.link == link.name]
    if own:
        return Body(link.name, tuple(_mesh_piece(number, mesh) for number, mesh in enumerate(own)))
    visuals = [visual.shape for visual in link.visuals if not isinstance(visual.shape, MeshFile)]
    shapes = visuals if visuals and len(visuals) == len(link.visuals) else link.collision_geometry
    return Body(link.name, tuple(Piece(str(number), _drawn(shape), color) for number, shape in enumerate(shapes)))


def _drawn(shape: CollisionGeometry) -> Primitive | Surface:
    """A primitive, or the faces of a hull, each with corners of its own, so that edges are sharp."""
    if isinstance(shape, Solid):
        placed = np.eye(4)
        placed[:3, :3], placed[:3, 3] = rotation(shape.rpy), shape.at
        return Primitive(shape.kind, shape.size, _as_pose(placed[None])[0])
    faces = shape.corners()[shape.triangles].reshape(-1, 3)
    return Surface(faces, np.arange(len(faces)).reshape(-1, 3))


def _mesh_piece(number: int, mesh: LinkMesh) -> Piece:
    red, green, blue = (round(255 * channel) for channel in mesh.color)
    return Piece(str(number), Surface(mesh.vertices, mesh.triangles), (red, green, blue, 255))


def _as_matrix(pose: FloatArray) -> FloatArray:
    """``(4, 4)``."""
    matrix = np.eye(4)
    matrix[:3, 3], matrix[:3, :3] = pose[:3], Rotation.from_quat(pose[[4, 5, 6, 3]]).as_matrix()
    return matrix


def _as_pose(matrices: FloatArray) -> FloatArray:
    """Poses ``(m, 7)`` of matrices ``(m, 4, 4)``."""
    quaternions = Rotation.from_matrix(matrices[:, :3, :3]).as_quat()
    return np.concatenate([matrices[:, :3, 3], quaternions[:, [3, 0, 1, 2]]], axis=1)
