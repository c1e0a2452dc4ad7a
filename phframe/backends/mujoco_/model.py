"""What all worlds of one MuJoCo backend have in common: the compiled model and where in it everything is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from phframe.backends.mujoco_.arm import PREFIX, arm_spec, lead
from phframe.backends.mujoco_.options import MujocoOptions
from phframe.backends.mujoco_.shelf import foot_name, object_name, shelf_spec
from phframe.core import ArmModel, BasePose, FloatArray, IntArray, Scene
from phframe.geometry.slabs import WALLS

FORCE_SENSOR = "force on the arm"


@dataclass(frozen=True, slots=True, eq=False)
class MujocoModel:
    """The compiled model. Addresses are in MuJoCo's arrays.

    Attributes:
        mj: The model.
        scene: What is modelled.
        object_poses: Of every object's pose in qpos, ``(n, 7)``.
        moving: Of every object's velocity in qvel, ``(n, 6)``.
        bodies: Of every object ``(n,)``.
        hulls: Geoms that meet all but the board, one for every object ``(n,)``.
        feet: Geoms that stand on the board, one for every object ``(n,)``.
        joints: Of the arm's joints in qpos ``(dof,)``.
        speeds: Of the arm's joints in qvel ``(dof,)``.
        fingers: Of the two fingers in qpos ``(2,)``.
        lead: Seconds by which commands lead moving joints ``(dof,)``.
        tip: Body of the fingertip frame.
        is_arm: Whether a geom is the arm's: of a body that hangs on its root, whatever its name.
        names: What a geom is called: a part of the arm, an object, a wall, the board.
        is_wall: Whether a geom is a wall or the ceiling.
        sides: Which finger a geom is, +1 left, -1 right, 0 none.
        rows: Which object a geom is, None for others.
    """

    mj: Any
    scene: Scene
    object_poses: IntArray
    moving: IntArray
    bodies: IntArray
    hulls: IntArray
    feet: IntArray
    joints: IntArray
    speeds: IntArray
    fingers: IntArray
    lead: FloatArray
    tip: int
    is_arm: tuple[bool, ...]
    names: tuple[str, ...]
    is_wall: tuple[bool, ...]
    sides: tuple[int, ...]
    rows: tuple[int | None, ...]

    @property
    def dof(self) -> int:
        """Number of the arm's joints; the fingers' controls come after them."""
        return len(self.joints)


def build_model(scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: MujocoOptions) -> MujocoModel:
    """Compile a scene with an arm in it.

    Raises:
        IncompatibleError: If the arm's URDF does not load.
        UnknownShapeError: If MuJoCo has no primitive for the shape of an object.
    """
    spec = shelf_spec(scene, options)
    robot = arm_spec(arm, options)
    root = PREFIX + robot.worldbody.first_body().name
    frame = spec.worldbody.add_frame(pos=base_pose.pose[:3], quat=base_pose.pose[3:])
    spec.attach(robot, prefix=PREFIX, frame=frame)
    _add_force_sensor(spec, root)
    mj = spec.compile()
    return _indexed(mj, mj.body(root).id, scene, arm)


def _add_force_sensor(spec: Any, root: str) -> None:
    """Number of contacts of all that hangs on a body, and their net force, summed up by the engine itself."""
    data, net_force = mujoco.mjtConDataField, 3
    spec.add_sensor(
        name=FORCE_SENSOR,
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_XBODY,
        objname=root,
        intprm=[1 << int(data.mjCONDATA_FOUND) | 1 << int(data.mjCONDATA_FORCE), net_force, 1],
    )


def _indexed(mj: Any, root: int, scene: Scene, arm: ArmModel[Any]) -> MujocoModel:
    objects = [mj.joint(object_name(row)) for row in range(len(scene.objects))]
    is_arm = tuple(int(mj.body_rootid[body]) == root for body in mj.geom_bodyid)
    rows = {int(mj.body(object_name(row)).id): row for row in range(len(scene.objects))}
    links = [mj.body(PREFIX + link).id for link in arm.fingers.links]
    object_poses = np.array([joint.qposadr[0] + np.arange(7) for joint in objects]).reshape(-1, 7)
    return MujocoModel(
        mj=mj,
        scene=scene,
        object_poses=object_poses,
        moving=np.array([joint.dofadr[0] + np.arange(6) for joint in objects]).reshape(-1, 6),
        bodies=np.array([mj.body(object_name(row)).id for row in range(len(scene.objects))]),
        hulls=np.array([mj.geom(object_name(row)).id for row in range(len(scene.objects))]),
        feet=np.array([mj.geom(foot_name(row)).id for row in range(len(scene.objects))]),
        joints=_addresses(mj, [joint.name for joint in arm.joints]),
        speeds=np.array([int(mj.joint(PREFIX + joint.name).dofadr[0]) for joint in arm.joints]),
        fingers=_addresses(mj, [joint.name for joint in arm.fingers.joints]),
        lead=lead(mj, range(len(arm.joints))),
        tip=mj.body(PREFIX + arm.tip_link).id,
        is_arm=is_arm,
        names=_geom_names(mj, is_arm, scene, arm),
        is_wall=tuple(mj.geom(row).name in WALLS for row in range(mj.ngeom)),
        sides=tuple(_side(int(body), links) for body in mj.geom_bodyid),
        rows=tuple(rows.get(int(body)) for body in mj.geom_bodyid),
    )


def _addresses(mj: Any, joints: list[str]) -> IntArray:
    return np.array([int(mj.joint(PREFIX + name).qposadr[0]) for name in joints])


def _side(body: int, links: list[int]) -> int:
    return 0 if body not in links else 1 if body == links[0] else -1


def _geom_names(mj: Any, is_arm: tuple[bool, ...], scene: Scene, arm: ArmModel[Any]) -> tuple[str, ...]:
    """Parts of the arm as its outlines call them, or else its links; objects by id; walls and board as they are."""
    parts = {outline.part for outline in arm.shape.closed}
    objects = {name(row): item.id for row, item in enumerate(scene.objects) for name in (object_name, foot_name)}
    names = []
    for row in range(mj.ngeom):
        geom = mj.geom(row).name
        own = geom.removeprefix(PREFIX).removesuffix(" collision")
        link = mj.body(int(mj.geom_bodyid[row])).name.removeprefix(PREFIX)
        names.append((own if own in parts else link) if is_arm[row] else objects.get(geom, geom))
    return tuple(names)
