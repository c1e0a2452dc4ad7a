"""Puts an arm into PyBullet: its URDF with soft collision geometry, joints that follow others coupled; places and weighs it.

A motor is a constraint on a joint's speed with a greatest force: rigid up to there, and never unstable.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from phframe.backends.pybullet_.bodies import ARM, ARM_MEETS
from phframe.backends.pybullet_.options import PybulletOptions
from phframe.backends.pybullet_.output_capture import bullet, caught_output
from phframe.backends.pybullet_.urdf import PreparedUrdf
from phframe.core import ArmModel, BasePose, FloatArray, IncompatibleError
from phframe.urdf.model import Mimic

COUPLING_FORCE = 1000.0
"""Greatest force or torque between coupled joints (N or Nm): more than anything here can push with."""
COUPLING_GAIN = 0.2
"""Fraction of the difference between coupled joints that is made good in a step."""
FRACTIONS = (0.1, 0.4, 0.8)
"""Of the joints' ranges: joint values at which to see whether an arm's weight moves its joints."""


@dataclass(frozen=True, slots=True)
class FollowingJoint:
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
    followers: tuple[FollowingJoint, ...]
    infos: tuple[Any, ...]
    tip: int
    parts: Mapping[int, str]
    sides: Mapping[int, int]


def load_arm(
    client: int, arm: ArmModel[Any], base_pose: BasePose, urdf: PreparedUrdf, options: PybulletOptions
) -> LoadedArm:
    """Put an arm at its base pose; its joints are at 0.

    Raises:
        IncompatibleError: If PyBullet cannot load the URDF.
    """
    body = _load(client, arm, base_pose, urdf)
    loaded = _indexed(client, body, arm, urdf)
    for link in loaded.parts:
        _soften(client, body, link, options)
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


def _followers(
    couplings: Mapping[str, Mimic], joints: Mapping[str, int], driven: Sequence[int]
) -> list[FollowingJoint]:
    found = (
        FollowingJoint(joints[name], joints[mimic.joint], mimic.multiplier, mimic.offset)
        for name, mimic in couplings.items()
    )
    return [follower for follower in found if follower.joint not in driven]


def _soften(client: int, body: int, link: int, options: PybulletOptions) -> None:
    bullet.setCollisionFilterGroupMask(body, link, ARM, ARM_MEETS, physicsClientId=client)
    friction = options.against_objects(options.arm_friction)
    bullet.changeDynamics(
        body,
        link,
        **friction,
        contactStiffness=options.arm_stiffness,
        contactDamping=options.arm_damping,
        physicsClientId=client,
    )


def _couple(client: int, body: int, joints: Mapping[str, int], name: str, mimic: Mimic) -> None:
    """Hold two joints together; PyBullet itself ignores ``mimic``."""
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


def place_joints(client: int, loaded: LoadedArm, arm: ArmModel[Any], values: Sequence[float]) -> None:
    """Put arm and fingers where they are to be ``(dof + 2,)``, and hold them there; never while anything moves.

    No joint will be faster than it is made for, however far it is behind: that is set here for all that follows.
    """
    for number, joint, value in zip(loaded.joints, (*arm.joints, *arm.fingers.joints), values, strict=True):
        _hold(client, loaded.body, number, value, force=joint.effort, maxVelocity=joint.velocity)
    followers = {follower.joint for follower in loaded.followers}
    for number in sorted(set(loaded.movable) - set(loaded.joints) - followers):
        lower, upper, effort = loaded.infos[number][8:11]
        # Bullet says that there are no limits by limits the wrong way round.
        _hold(client, loaded.body, number, min(max(0.0, lower), upper) if lower <= upper else 0.0, force=effort)
    for follower in loaded.followers:
        leading = bullet.getJointState(loaded.body, follower.leader, physicsClientId=client)[0]
        value = follower.ratio * leading + follower.offset
        bullet.resetJointState(loaded.body, follower.joint, value, physicsClientId=client)
        bullet.setJointMotorControl2(
            loaded.body, follower.joint, bullet.VELOCITY_CONTROL, force=0.0, physicsClientId=client
        )


def weight(client: int, arm: LoadedArm, values: Sequence[float]) -> tuple[float, ...]:
    """What all joints that can move have to give so that the arm does not sag, at their values (N or Nm)."""
    still = [0.0] * len(values)
    efforts: tuple[float, ...] = bullet.calculateInverseDynamics(
        arm.body, list(values), still, still, physicsClientId=client
    )
    return efforts


def sags(client: int, arm: LoadedArm) -> bool:
    """Whether an arm's own weight moves any joint: not where they all slide level or turn about the vertical."""
    ranges = [arm.infos[joint][8:10] for joint in arm.movable]
    samples = ([lower + fraction * (upper - lower) for lower, upper in ranges] for fraction in FRACTIONS)
    return any(any(weight(client, arm, values)) for values in samples)


def inertias(client: int, arm: LoadedArm, values: Sequence[float]) -> FloatArray:
    """What each of ``joints`` has to accelerate, at the values of all that can move (kg or kg m^2)."""
    matrix = np.array(bullet.calculateMassMatrix(arm.body, list(values), physicsClientId=client))
    return np.asarray(np.diag(matrix)[list(arm.controlled)])


def _hold(client: int, body: int, joint: int, value: float, **limits: float) -> None:
    bullet.resetJointState(body, joint, value, physicsClientId=client)
    bullet.setJointMotorControl2(
        body, joint, bullet.POSITION_CONTROL, targetPosition=value, **limits, physicsClientId=client
    )
