"""Surface points of an arm's collision geometry, and how they move: what tells how wide a configuration is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from phframe.core import BasePose, FloatArray, rotation_matrix
from phframe.motion.pinocchio_ import Kinematics
from phframe.urdf.model import CollisionGeometry, Robot
from phframe.urdf.solids import FACETS, ORIGIN, Vector, rotation

AROUND, ALONG = 8, 5
"""Points around a cylinder, and rings of them along it."""


class SurfacePoints:
    """Points on those links of an arm behind the gripper that can come into a shelf.

    Args:
        kinematics: Of the arm.
        robot: Its links.
        joints: Names of its joints, from the base to the gripper.
        tip: The gripper's link, which is not looked at: it goes wherever the gripper does.
        base_pose: Where the base stands.
        depth: Of the shelf (m).
    """

    def __init__(
        self, kinematics: Kinematics, robot: Robot, joints: Sequence[str], tip: str, base_pose: BasePose, depth: float
    ) -> None:
        self._kinematics = kinematics
        inside = _links_inside(robot, joints, tip, depth)
        self._points = {row: np.vstack(found) for row, name in inside if (found := list(_on_link(robot, name, tip)))}
        self._axes = np.eye(3)
        self._axes[:2, :2] = rotation_matrix(base_pose.yaw)
        self._at = np.array([base_pose.x, base_pose.y, base_pose.z])

    def seen(self, q: FloatArray, direction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The points ``(k, 3)`` in the shelf frame (m), and how they move as joints move in a direction ``(dof,)``."""
        frames = self._kinematics.joint_frames(q, direction)
        points, speeds = [], []
        for row, own in self._points.items():
            axes, at, angular, linear = frames[row]
            off = own @ axes.T
            points.append(off + at)
            speeds.append(off @ _cross_product(angular) + linear)
        return np.vstack(points) @ self._axes.T + self._at, np.vstack(speeds) @ self._axes.T


def _cross_product(angular: FloatArray) -> FloatArray:
    """The matrix ``(3, 3)`` that takes row vectors ``r`` to ``w x r`` for an angular velocity ``w``."""
    x, y, z = angular.tolist()
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


def _links_inside(robot: Robot, joints: Sequence[str], tip: str, depth: float) -> list[tuple[int, str]]:
    """Number of the joint and name of the link, of all whose far end is no farther behind the fingertip than ``depth``."""
    found, behind, child = [], 0.0, tip
    for row in range(len(joints) - 1, -1, -1):
        link = robot.joint(joints[row]).child
        while child != link:
            behind += float(np.linalg.norm(robot.parent_joints[child].at))
            child = robot.parent_joints[child].parent
        if behind > depth:
            break
        found.append((row, link))
    return found


def _on_link(robot: Robot, link: str, tip: str, at: Vector = ORIGIN, rpy: Vector = ORIGIN) -> Iterator[FloatArray]:
    """Points ``(k, 3)`` on a link and on all that is fixed to it, in the frame of the joint that carries it."""
    axes = rotation(rpy)
    for solid in robot.collision_geometry[link]:
        yield _points(solid) @ axes.T + at
    for connection in robot.parent_joints.values():
        if connection.parent == link and connection.joint is None and connection.child != tip:
            for points in _on_link(robot, connection.child, tip, connection.at, connection.rpy):
                yield points @ axes.T + at


def _points(solid: CollisionGeometry) -> FloatArray:
    """On the surface of a solid, in the frame of its link."""
    corners = solid.corners()
    if solid.kind != "cylinder":
        return corners
    rims = corners.reshape(2, FACETS, 3)[:, :: FACETS // AROUND]
    return np.vstack([rims[0] + fraction * (rims[1] - rims[0]) for fraction in np.linspace(0.0, 1.0, ALONG)])
