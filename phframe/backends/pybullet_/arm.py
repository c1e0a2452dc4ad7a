"""Puts an arm into PyBullet: its URDF, covered with something that gives, joints that follow others coupled."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from phframe.backends.pybullet_.bodies import ARM, BOX, OBJECT, Surfaces
from phframe.backends.pybullet_.output_capture import bullet, caught_output
from phframe.backends.pybullet_.urdf import PreparedUrdf
from phframe.core import ArmModel, BasePose, IncompatibleError
from phframe.urdf.model import Mimic

STIFFNESS, DAMPING = 5e3, 50.0
"""Of the arm's cover at every point of contact (N/m, Ns/m). A rigid one would make a blow of every touch."""
COUPLING_FORCE = 1000.0
"""Greatest force or torque between coupled joints (N or Nm): more than anything here can push with."""
COUPLING_GAIN = 0.2
"""Fraction of the difference between coupled joints that is made good in a step."""


@dataclass(frozen=True, slots=True)
class Follower:
    """A joint that follows another, by PyBullet's numbers; see ``Mimic``."""

    joint: int
    leader: int
    ratio: float
    offset: float


@dataclass(frozen=True, slots=True)
class LoadedArm:
    """Where an arm is, by PyBullet's numbers.

    Attributes:
        body: The arm.
        joints: Of ``arm.joints``, then the two fingers.
        movable: All joints that can move, in PyBullet's order.
        controlled: Places of ``joints`` among ``movable``.
        followers: Joints that follow others, and are not in ``joints``.
        infos: What PyBullet says of every joint.
        tip: Link of the fingertip frame.
        parts: What a link is called in a contact.
        sides: Which links are fingers, +1 left, -1 right.
    """

    body: int
    joints: tuple[int, ...]
    movable: tuple[int, ...]
    controlled: tuple[int, ...]
    followers: tuple[Follower, ...]
    infos: tuple[Any, ...]
    tip: int
    parts: Mapping[int, str]
    sides: Mapping[int, int]


def load_arm(client: int, arm: ArmModel[Any], base_pose: BasePose, urdf: PreparedUrdf, surfaces: Surfaces) -> LoadedArm:
    """Put an arm at its base pose; its joints are at 0.

    Raises:
        IncompatibleError: If PyBullet cannot load the URDF.
    """
    body = _load(client, arm, base_pose, urdf)
    loaded = _indexed(client, body, arm, urdf)
    for link in loaded.parts:
        _cover(client, body, link, surfaces)
    bullet.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0, physicsClientId=client)
    numbers = {info[1].decode(): info[0] for info in loaded.infos}
    for follower, mimic in urdf.couplings.items():
        _couple(client, body, numbers, follower, mimic)
    return loaded


def _load(client: int, arm: ArmModel[Any], base_pose: BasePose, urdf: PreparedUrdf) -> int:
    x, y, z, qw, qx, qy, qz = base_pose.pose.tolist()
    with tempfile.TemporaryDirectory() as folder, caught_output() as said:
        path = Path(folder) / "arm.urdf"  # PyBullet reads files only
        path.write_text(urdf.text, encoding="utf-8")
        for name, content in urdf.files.items():
            (path.parent / name).write_bytes(content)
        try:
            body: int = bullet.loadURDF(
                str(path),
                basePosition=[x, y, z],
                baseOrientation=[qx, qy, qz, qw],
                useFixedBase=True,
                flags=bullet.URDF_USE_INERTIA_FROM_FILE | bullet.URDF_USE_IMPLICIT_CYLINDER,
                physicsClientId=client,
            )
        except bullet.error:
            body = -1
    if body < 0:
        why = said[-1].strip() if said else "it does not say why"
        raise IncompatibleError(f"PyBullet cannot load the URDF of {type(arm).__name__}: {why}")
    return body


def _indexed(client: int, body: int, arm: ArmModel[Any], urdf: PreparedUrdf) -> LoadedArm:
    count = bullet.getNumJoints(body, physicsClientId=client)
    infos = tuple(bullet.getJointInfo(body, joint, physicsClientId=client) for joint in range(count))
    joints = {info[1].decode(): info[0] for info in infos}
    links = {bullet.getBodyInfo(body, physicsClientId=client)[0].decode(): -1}
    links |= {info[12].decode(): info[0] for info in infos}
    movable = tuple(info[0] for info in infos if info[2] != bullet.JOINT_FIXED)
    driven = tuple(joints[joint.name] for joint in (*arm.joints, *arm.fingers.joints))
    left, right = arm.fingers.links
    return LoadedArm(
        body=body,
        joints=driven,
        movable=movable,
        controlled=tuple(movable.index(joint) for joint in driven),
        followers=tuple(_followers(urdf.couplings, joints, driven)),
        infos=infos,
        tip=links[arm.tip_link],
        parts={number: urdf.parts[name] for name, number in links.items()},
        sides={links[left]: 1, links[right]: -1},
    )


def _followers(couplings: Mapping[str, Mimic], joints: Mapping[str, int], driven: Sequence[int]) -> list[Follower]:
    found = (
        Follower(joints[name], joints[mimic.joint], mimic.multiplier, mimic.offset) for name, mimic in couplings.items()
    )
    return [follower for follower in found if follower.joint not in driven]


def _cover(client: int, body: int, link: int, surfaces: Surfaces) -> None:
    bullet.setCollisionFilterGroupMask(body, link, ARM, OBJECT | BOX, physicsClientId=client)
    friction = surfaces.against_objects(surfaces.arm)
    bullet.changeDynamics(
        body, link, **friction, contactStiffness=STIFFNESS, contactDamping=DAMPING, physicsClientId=client
    )


def _couple(client: int, body: int, joints: Mapping[str, int], name: str, mimic: Mimic) -> None:
    """Hold two joints together; PyBullet itself passes over ``mimic``."""
    origin = [0.0, 0.0, 0.0]
    leader, follower = joints[mimic.joint], joints[name]
    gear = bullet.createConstraint(
        body, leader, body, follower, bullet.JOINT_GEAR, [0.0, 1.0, 0.0], origin, origin, physicsClientId=client
    )
    # It keeps the leader plus gearRatio times the follower at relativePositionTarget.
    bullet.changeConstraint(
        gear,
        gearRatio=-1.0 / mimic.multiplier,
        relativePositionTarget=-mimic.offset / mimic.multiplier,
        erp=COUPLING_GAIN,
        maxForce=COUPLING_FORCE,
        physicsClientId=client,
    )
