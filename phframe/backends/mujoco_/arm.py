"""Puts an arm into MuJoCo: its URDF, position control on every joint with the joint's real effort, gravity compensated."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from phframe.backends.mujoco_.options import MujocoOptions
from phframe.backends.mujoco_.shelf import ARM_KIND, ARM_MEETS
from phframe.core import ArmModel, FloatArray, IncompatibleError, InputError, Joint
from phframe.urdf.convex_hull import ConvexHull
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import rotation
from phframe.urdf.writer import robot_urdf

PREFIX = "arm/"
"""Of the names of all that belongs to the arm."""
FASTEST = 250.0
"""Of the servos' natural frequencies (rad/s): light joints get rotor inertia until they are no faster."""


@dataclass(frozen=True, slots=True)
class Servo:
    """Gains of one position-controlled joint.

    Attributes:
        joint: Its name.
        stiffness: Force or torque per error (N/m or Nm/rad).
        damping: Force or torque per speed error.
        inertia: Of the rotor, as the joint feels it.
        effort: Greatest force or torque.
    """

    joint: str
    stiffness: float
    damping: float
    inertia: float
    effort: float


def arm_spec(arm: ArmModel[Any], options: MujocoOptions) -> Any:
    """The arm as a MuJoCo spec, with an actuator for every joint: first those of ``arm.joints``, then the two fingers.

    Raises:
        IncompatibleError: If the URDF does not load, or lacks a joint or link that the arm names.
    """
    spec = _load(arm)
    _check_names(arm, spec)
    friction = options.triple(options.arm_friction)
    for body in spec.bodies:
        body.gravcomp = 1.0
    for geom in spec.geoms:
        geom.contype, geom.conaffinity = ARM_KIND, ARM_MEETS
        geom.priority, geom.friction, geom.condim, geom.solref = 2, friction, 4, options.contact
    for servo in _servos(arm, spec, options):
        _add_servo(spec, servo)
    for mimic in spec.equalities:
        mimic.solref, mimic.solimp = [0.004, 1.0], [0.99, 0.999, 0.0001, 0.5, 2.0]
    return spec


def _load(arm: ArmModel[Any]) -> Any:
    """The robot without visuals; convex hulls are put into the model itself, which then needs no files."""
    try:
        robot = read_robot(arm.urdf())
        root = ET.fromstring(robot_urdf(robot.without_hulls()))
        # MuJoCo would merge links that are fixed to one another, and lose the fingertip.
        ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", fusestatic="false")
        spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    except (InputError, ValueError) as error:
        raise _refused(arm, error) from None
    for number, (link, hull) in enumerate(robot.hulls):
        _add_hull(spec, number, link, hull)
    return spec


def _refused(arm: ArmModel[Any], error: Exception) -> IncompatibleError:
    why = " ".join(str(error).split())
    return IncompatibleError(f"MuJoCo cannot load the URDF of {type(arm).__name__}: {why}")


def _add_hull(spec: Any, number: int, link: str, hull: ConvexHull) -> None:
    name = f"hull {number}"
    spec.add_mesh(name=name, uservert=hull.vertices.ravel(), userface=hull.triangles.ravel())
    x, y, z, w = Rotation.from_matrix(rotation(hull.rpy)).as_quat()
    spec.body(link).add_geom(
        name=f"{hull.name or f'{link} {hull.part or number}'} collision",
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        pos=hull.at,
        quat=(w, x, y, z),
    )


def _check_names(arm: ArmModel[Any], spec: Any) -> None:
    joints, links = {joint.name for joint in spec.joints}, {body.name for body in spec.bodies}
    wanted = [joint.name for joint in (*arm.joints, *arm.fingers.joints)]
    lacking = [name for name in wanted if name not in joints]
    lacking += [name for name in (arm.tip_link, *arm.fingers.links) if name not in links]
    if lacking:
        raise IncompatibleError(f"the URDF of {type(arm).__name__} has no joint or link {', '.join(lacking)}")


def _servos(arm: ArmModel[Any], spec: Any, options: MujocoOptions) -> list[Servo]:
    """A critically damped servo for each joint."""
    try:
        model = spec.compile()
    except ValueError as error:
        raise _refused(arm, error) from None
    pairs: list[tuple[Joint, float]] = [*((joint, options.joint_give) for joint in arm.joints)]
    pairs += [(joint, options.finger_give) for joint in arm.fingers.joints]
    return [_servo(joint, error, float(model.dof_M0[model.joint(joint.name).dofadr[0]])) for joint, error in pairs]


def _servo(joint: Joint, give: float, inertia: float) -> Servo:
    """A position servo tau = k (q* - q) - d qd, critically damped: d = 2 sqrt(k (M + rotor)).

    Its natural frequency sqrt(k / (M + rotor)) is held below ``FASTEST`` by the rotor's inertia, so that steps resolve it
    (Siciliano et al., Robotics: Modelling, Planning and Control, 2009, section 8.3: independent joint control).
    """
    stiffness = joint.effort / give
    rotor = max(0.0, stiffness / FASTEST**2 - inertia)
    damping = 2.0 * float(np.sqrt(stiffness * (inertia + rotor)))
    return Servo(joint.name, stiffness, damping, rotor, joint.effort)


def _add_servo(spec: Any, servo: Servo) -> None:
    joint = spec.joint(servo.joint)
    joint.armature = servo.inertia
    joint.actfrcrange = [-servo.effort, servo.effort]
    joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE
    actuator = spec.add_actuator(
        name=servo.joint,
        target=servo.joint,
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        forcelimited=mujoco.mjtLimited.mjLIMITED_TRUE,
        forcerange=[-servo.effort, servo.effort],
        ctrllimited=mujoco.mjtLimited.mjLIMITED_FALSE,
    )
    actuator.set_to_position(kp=servo.stiffness, kv=servo.damping)


def lead(model: Any, actuators: Sequence[int]) -> FloatArray:
    """Seconds by which a command must lead a moving joint, so that damping does not hold it back, ``(k,)``."""
    rows = list(actuators)
    return np.asarray(model.actuator_biasprm[rows, 2] / model.actuator_biasprm[rows, 1])
