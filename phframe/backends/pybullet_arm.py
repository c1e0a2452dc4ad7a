"""Puts an arm into PyBullet: its URDF, a motor on every joint with the joint's real speed and effort."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from phframe.backends.pybullet_quiet import bullet, caught_output
from phframe.backends.pybullet_shelf import ARM, BOX, OBJECT, Surfaces
from phframe.backends.pybullet_urdf import Coupling, PreparedUrdf
from phframe.core import ArmModel, FloatArray, IncompatibleError, Mount

SHARES = (0.1, 0.4, 0.8)
"""Of the joints' ranges: postures in which to see whether an arm's weight moves its joints."""
STIFFNESS, DAMPING = 5e3, 50.0
"""Of the arm's cover at every point of contact (N/m, Ns/m). A rigid one would make a blow of every touch."""
COUPLING_FORCE = 1000.0
"""Greatest force or torque between coupled joints (N or Nm): more than anything here can push with."""
COUPLING_GAIN = 0.2
"""Share of the difference between coupled joints that is made good in a step."""


@dataclass(frozen=True, slots=True)
class LoadedArm:
    """Where an arm is, by PyBullet's numbers.

    Attributes:
        body: The arm.
        joints: Of ``arm.joints``, then the two fingers.
        movable: All joints that can move, in PyBullet's order.
        controlled: Places of ``joints`` among ``movable``.
        tip: Link of the fingertip frame.
        parts: What a link is called in a contact.
        sides: Which links are fingers, +1 left, -1 right.
        sags: Whether its own weight moves any joint.
    """

    body: int
    joints: tuple[int, ...]
    movable: tuple[int, ...]
    controlled: tuple[int, ...]
    tip: int
    parts: Mapping[int, str]
    sides: Mapping[int, int]
    sags: bool = True


def load_arm(client: int, arm: ArmModel[Any], mount: Mount, urdf: PreparedUrdf, surfaces: Surfaces) -> LoadedArm:
    """Put an arm at its mount; its joints are at 0 and move freely.

    Raises:
        IncompatibleError: If PyBullet cannot load the URDF.
    """
    body = _load(client, arm, mount, urdf.text)
    count = bullet.getNumJoints(body, physicsClientId=client)
    infos = [bullet.getJointInfo(body, joint, physicsClientId=client) for joint in range(count)]
    joints = {info[1].decode(): info[0] for info in infos}
    links = {info[12].decode(): info[0] for info in infos}
    links[bullet.getBodyInfo(body, physicsClientId=client)[0].decode()] = -1
    for link in links.values():
        bullet.setCollisionFilterGroupMask(body, link, ARM, OBJECT | BOX, physicsClientId=client)
        bullet.changeDynamics(
            body,
            link,
            **surfaces.against_objects(surfaces.arm),
            contactStiffness=STIFFNESS,
            contactDamping=DAMPING,
            physicsClientId=client,
        )
    bullet.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0, physicsClientId=client)
    for coupling in urdf.couplings:
        _couple(client, body, joints, coupling)
    movable = tuple(info[0] for info in infos if info[2] != bullet.JOINT_FIXED)
    driven = tuple(joints[joint.name] for joint in (*arm.joints, *arm.fingers.joints))
    left, right = arm.fingers.links
    loaded = LoadedArm(
        body=body,
        joints=driven,
        movable=movable,
        controlled=tuple(movable.index(joint) for joint in driven),
        tip=links[arm.tip_link],
        parts={number: urdf.parts.get(name, name) for name, number in links.items()},
        sides={links[left]: 1, links[right]: -1},
    )
    followers = {joints[coupling.joint] for coupling in urdf.couplings}
    for joint in set(movable) - set(driven) - followers:
        _hold_still(client, body, infos[joint])
    postures = ([share * (info[9] - info[8]) + info[8] for info in infos if info[0] in movable] for share in SHARES)
    return replace(loaded, sags=any(any(weight(client, loaded, posture)) for posture in postures))


def place_joints(client: int, loaded: LoadedArm, arm: ArmModel[Any], values: Sequence[float]) -> None:
    """Put arm and fingers where they are to be ``(dof + 2,)``, and hold them there; never while anything moves.

    No joint will be faster than it is made for, however far it is behind: that is set here for all that follows.
    """
    joints = (*arm.joints, *arm.fingers.joints)
    for number, joint, value in zip(loaded.joints, joints, values, strict=True):
        bullet.resetJointState(loaded.body, number, value, physicsClientId=client)
        bullet.setJointMotorControl2(
            loaded.body,
            number,
            bullet.POSITION_CONTROL,
            targetPosition=value,
            force=joint.effort,
            maxVelocity=joint.velocity,
            physicsClientId=client,
        )


def _load(client: int, arm: ArmModel[Any], mount: Mount, text: str) -> int:
    x, y, z, qw, qx, qy, qz = mount.pose.tolist()
    with tempfile.TemporaryDirectory() as folder, caught_output() as said:
        path = Path(folder) / "arm.urdf"
        path.write_text(text, encoding="utf-8")
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
        why = said[-1] if said else "it does not say why"
        raise IncompatibleError(f"PyBullet cannot load the URDF of {type(arm).__name__}: {why}")
    return body


def _couple(client: int, body: int, joints: Mapping[str, int], coupling: Coupling) -> None:
    """Hold two joints together; PyBullet itself passes over ``mimic``."""
    gear = bullet.createConstraint(
        body,
        joints[coupling.leader],
        body,
        joints[coupling.joint],
        bullet.JOINT_GEAR,
        jointAxis=[0.0, 1.0, 0.0],
        parentFramePosition=[0.0, 0.0, 0.0],
        childFramePosition=[0.0, 0.0, 0.0],
        physicsClientId=client,
    )
    # It keeps the leader plus gearRatio times the follower at relativePositionTarget.
    bullet.changeConstraint(
        gear,
        gearRatio=-1.0 / coupling.ratio,
        relativePositionTarget=-coupling.offset / coupling.ratio,
        erp=COUPLING_GAIN,
        maxForce=COUPLING_FORCE,
        physicsClientId=client,
    )


def _hold_still(client: int, body: int, info: tuple[Any, ...]) -> None:
    """Let a joint that is none of the arm's stay where it is, at 0 or as near as it can be."""
    joint, lower, upper, effort = info[0], info[8], info[9], info[10]
    value = min(max(0.0, lower), upper) if lower <= upper else 0.0  # Bullet's way to say that there are no limits
    bullet.resetJointState(body, joint, value, physicsClientId=client)
    bullet.setJointMotorControl2(
        body, joint, bullet.POSITION_CONTROL, targetPosition=value, force=effort, physicsClientId=client
    )


def weight(client: int, arm: LoadedArm, values: Sequence[float]) -> tuple[float, ...]:
    """What all joints that can move have to give so that the arm does not sag, at their values (N or Nm)."""
    still = [0.0] * len(values)
    efforts: tuple[float, ...] = bullet.calculateInverseDynamics(
        arm.body, list(values), still, still, physicsClientId=client
    )
    return efforts


def inertias(client: int, arm: LoadedArm, values: Sequence[float]) -> FloatArray:
    """What each of ``joints`` has to accelerate, at the values of all that can move (kg or kg m^2)."""
    matrix = np.array(bullet.calculateMassMatrix(arm.body, list(values), physicsClientId=client))
    return np.asarray(np.diag(matrix)[list(arm.controlled)])
