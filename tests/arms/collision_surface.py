"""Where the collision geometry of an arm is, sampled from its URDF alone, and how far it stands out beside the gripper's axis."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pinocchio

from phframe.core import ArmModel, BasePose, FloatArray, compose, inverse
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import Solid, rotation


class CollisionSurface:
    """The surface of an arm's collision geometry as points.

    Args:
        arm: The arm.
        mount: Where its base stands in the shelf frame.
        links: Begin or end of the names of the links that count.
    """

    def __init__(self, arm: ArmModel[Any], base_pose: BasePose, links: tuple[str, ...]) -> None:
        self._model = pinocchio.buildModelFromXML(arm.urdf())
        self._data, self._base_pose = self._model.createData(), base_pose.pose
        rows = [self._model.idx_qs[self._model.getJointId(joint.name)] for joint in arm.joints]
        self._rows = np.array(rows)
        self._points = {
            self._model.getFrameId(link): np.vstack([surface(solid) for solid in solids if isinstance(solid, Solid)])
            for link, solids in read_robot(arm.urdf()).collision_geometry.items()
            if solids and link in links
        }
        self._arm = arm

    def in_shelf(self, q: FloatArray) -> FloatArray:
        """Points ``(n, 3)`` on the surface in the shelf frame for joint values ``(dof,)``, fingers closed."""
        values = np.zeros(self._model.nq)
        values[self._rows] = q
        pinocchio.framesForwardKinematics(self._model, self._data, values)
        places = [(self._data.oMf[frame], points) for frame, points in self._points.items()]
        points = np.vstack([points @ place.rotation.T + place.translation for place, points in places])
        return points @ matrix(self._base_pose[3:]).T + self._base_pose[:3]

    def behind_tip(self, q: FloatArray) -> FloatArray:
        """Of the points beyond the mouth: x, y, z seen from the fingertip ``(n, 3)``."""
        points = self.in_shelf(q)
        tip = inverse(compose(self._base_pose, self._arm.forward(q)))
        return points[points[:, 0] > 0.0] @ matrix(tip[3:]).T + tip[:3]


def matrix(quaternion: FloatArray) -> FloatArray:
    """The matrix ``(3, 3)`` of a unit quaternion ``(4,)``, scalar first."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def surface(solid: Solid, across: int = 17) -> FloatArray:
    """Points ``(n, 3)`` on the surface of a solid in the frame of its link."""
    steps = np.linspace(-0.5, 0.5, across)
    if solid.kind == "box":
        grid = np.array(list(product(steps, repeat=3)))
        points = grid[(np.abs(grid) == 0.5).any(axis=1)] * solid.size
    elif solid.kind == "cylinder":
        radius, length = solid.size
        angles = np.arange(36) * np.pi / 18.0
        rings = [(fraction * radius, height) for fraction in (0.5, 1.0) for height in (-length / 2.0, length / 2.0)]
        rings += [(radius, height) for height in steps * length]
        points = np.vstack(
            [np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(36, height)]) for r, height in rings]
        )
    else:
        raise NotImplementedError("no arm has a round end")
    return np.asarray(points @ rotation(solid.rpy).T + solid.at)
