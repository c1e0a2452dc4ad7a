"""An independent judge of collisions: MuJoCo, with the collision geometry of the arm, the shelf and the objects.

No margins: with them, MuJoCo 4 finds overlaps of boxes and cylinders where there are none, and misses others.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from itertools import product
from typing import Any

import mujoco
import numpy as np

from phframe.arms.articulated import ArticulatedArm
from phframe.core import BasePose, FloatArray, Scene, State, compose, inverse

THICKNESS = 0.1
"""Of board, walls and ceiling (m)."""
DEPTH = 1e-4
"""What overlaps by less (m) may be rounding."""


class Judge:
    """Looks at single configurations.

    Args:
        arm: The arm.
        scene: The shelf and its objects.
        mount: Of the arm.
    """

    def __init__(self, arm: ArticulatedArm[Any], scene: Scene, base_pose: BasePose) -> None:
        self._arm, self._scene, self._base = arm, scene, inverse(base_pose.pose)
        self._surroundings = {*scene.ids, *(name for name, *_ in _walls(scene))}
        spec = _robot(arm)
        for name, center, half in _walls(scene):
            self._add(spec, name, mujoco.mjtGeom.mjGEOM_BOX, half, [*center, 1.0, 0.0, 0.0, 0.0])
        for item in scene.objects:
            body = spec.worldbody.add_body(name=f"{item.id} ", mocap=True)
            size = [item.shape.radius, item.shape.height / 2.0, 0.0]
            body.add_geom(name=item.id, type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=size, contype=2, conaffinity=1)
        self._model = spec.compile()
        self._data = mujoco.MjData(self._model)
        joints = [joint.name for joint in (*arm.joints, *arm.fingers.joints)]
        self._rows = [int(self._model.joint(name).qposadr[0]) for name in joints]
        self._closed = np.array([joint.lower for joint in arm.fingers.joints])
        self.place(scene.initial_state())

    def place(self, state: State) -> None:
        """Let the objects stand where a state has them."""
        for row, item in enumerate(self._scene.objects):
            pose = compose(self._base, state.poses[row])
            number = self._model.body(f"{item.id} ").mocapid[0]
            self._data.mocap_pos[number], self._data.mocap_quat[number] = pose[:3], pose[3:]

    def touching(self, q: FloatArray, opening: float) -> set[tuple[str, str]]:
        """What overlaps what at joint values ``(dof,)`` with the fingers so far apart (m)."""
        fingers = self._closed + (opening - self._arm.shape.min_opening) / 2.0
        self._data.qpos[self._rows] = [*q, *fingers]
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        deep = [contact.geom for contact in self._data.contact if contact.dist < -DEPTH]
        return {(min(pair), max(pair)) for geoms in deep for pair in [tuple(self._name(int(geom)) for geom in geoms)]}

    def _name(self, geom: int) -> str:
        body = int(self._model.geom_bodyid[geom])
        own = self._model.geom(geom).name
        return str(own if own in self._surroundings else self._model.body(body).name)

    def _add(self, spec: Any, name: str, kind: Any, size: FloatArray, pose: list[float]) -> None:
        placed = compose(self._base, np.array(pose))
        spec.worldbody.add_geom(
            name=name, type=kind, size=size, pos=placed[:3], quat=placed[3:], contype=2, conaffinity=1
        )


def _robot(arm: ArticulatedArm[Any]) -> Any:
    """The arm, which may meet itself but where links are joined, or known to overlap, or fingers."""
    text = ET.fromstring(arm.urdf())
    ET.SubElement(ET.SubElement(text, "mujoco"), "compiler", fusestatic="false", discardvisual="true")
    spec = mujoco.MjSpec.from_string(ET.tostring(text, encoding="unicode"))
    for geom in spec.geoms:
        geom.contype, geom.conaffinity = 1, 3
    links = {body.name for body in spec.bodies}
    for a, b in {*arm.description.allowed_collisions, arm.fingers.links, *_on_the_base(arm)}:
        if {a, b} <= links:
            spec.add_exclude(bodyname1=a, bodyname2=b)
    return spec


def _on_the_base(arm: ArticulatedArm[Any]) -> Iterator[tuple[str, str]]:
    """What does not move, with what its first joint carries."""
    robot, first = arm.robot, arm.robot.joint(arm.joints[0].name).child

    def fixed(link: str) -> bool:
        hangs = robot.parent_joints.get(link)
        moving = {joint.name for joint in (*arm.joints, *arm.fingers.joints)}
        return hangs is None or ((hangs.joint is None or hangs.joint.name not in moving) and fixed(hangs.parent))

    yield from product([link for link in robot.links if fixed(link)], [first])


def _walls(scene: Scene) -> Iterator[tuple[str, FloatArray, FloatArray]]:
    """Name, centre and half of the size (m), as all backends have them."""
    d, w, h, t = scene.shelf.depth, scene.shelf.width, scene.shelf.height, THICKNESS
    for name, lower, upper in (
        ("board", (0.0, -t, -t), (d + t, w + t, 0.0)),
        ("ceiling", (0.0, -t, h), (d + t, w + t, h + t)),
        ("south wall", (0.0, -t, 0.0), (d, 0.0, h)),
        ("north wall", (0.0, w, 0.0), (d, w + t, h)),
        ("back wall", (d, -t, 0.0), (d + t, w + t, h)),
    ):
        low, high = np.array(lower), np.array(upper)
        yield name, (low + high) / 2.0, (high - low) / 2.0
