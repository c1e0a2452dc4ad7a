"""The joints of an arm in PyBullet: put in place before anything moves, held, weighed.

A motor is a constraint on a joint's speed with a greatest force: rigid up to there, and never unstable.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from phframe.backends.pybullet_.arm import LoadedArm
from phframe.backends.pybullet_.output_capture import bullet
from phframe.core import ArmModel, FloatArray

FRACTIONS = (0.1, 0.4, 0.8)
"""Of the joints' ranges: postures in which to see whether an arm's weight moves its joints."""


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
    postures = ([lower + fraction * (upper - lower) for lower, upper in ranges] for fraction in FRACTIONS)
    return any(any(weight(client, arm, posture)) for posture in postures)


def inertias(client: int, arm: LoadedArm, values: Sequence[float]) -> FloatArray:
    """What each of ``joints`` has to accelerate, at the values of all that can move (kg or kg m^2)."""
    matrix = np.array(bullet.calculateMassMatrix(arm.body, list(values), physicsClientId=client))
    return np.asarray(np.diag(matrix)[list(arm.controlled)])


def _hold(client: int, body: int, joint: int, value: float, **limits: float) -> None:
    bullet.resetJointState(body, joint, value, physicsClientId=client)
    bullet.setJointMotorControl2(
        body, joint, bullet.POSITION_CONTROL, targetPosition=value, **limits, physicsClientId=client
    )
