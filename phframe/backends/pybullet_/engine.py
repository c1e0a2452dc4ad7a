"""PyBullet as an engine of joints: bodies in a client behind ``JointEngine``."""

from __future__ import annotations

import math
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from phframe.backends.articulated import (
    ArmReading,
    ContactPair,
    EngineContact,
    ObjectReading,
    Placement,
    Progress,
    substeps,
)
from phframe.backends.pybullet_.arm import LoadedArm, inertias, load_arm, place_joints, sags, weight
from phframe.backends.pybullet_.options import PybulletOptions
from phframe.backends.pybullet_.output_capture import bullet
from phframe.backends.pybullet_.shelf import Bodies, build_shelf, set_held
from phframe.backends.pybullet_.sleeping import LOOK, Rest
from phframe.backends.pybullet_.urdf import prepared_urdf
from phframe.core import ArmModel, BasePose, FloatArray, Scene, seen_from_above
from phframe.core.scene import GRAVITY

NEAR = 1e-5
"""Bodies this close (m) touch, whether or not they press; Bullet tells of what is farther, too."""
SLOWING = 0.01
"""Time (s) in which an arm that complies loses its speed."""
COMPLIANT_EFFORT = 0.02
"""Fraction of its effort that a joint keeps while the arm complies."""


class PybulletEngine:
    """A scene with an arm in a client of PyBullet.

    Args:
        scene: The scene.
        arm: The arm.
        base_pose: Of the arm.
        options: Of the backend.

    Attributes:
        client: PyBullet's.
        bodies: Where everything but the arm is.
        loaded: Where the arm is.
        sags: Whether the arm's own weight moves any of its joints; they then carry it besides what their motors give.
        close: Gives the client back; done by itself when the engine is forgotten.

    Raises:
        IncompatibleError: If PyBullet cannot have the arm.
    """

    name = "pybullet"
    delay = 0.0
    bodies: Bodies
    loaded: LoadedArm
    sags: bool
    _rest: Rest

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: PybulletOptions) -> None:
        self._scene, self._arm, self._base_pose, self._options = scene, arm, base_pose, options
        self._urdf = prepared_urdf(arm)
        self.client: int = bullet.connect(bullet.DIRECT)
        # PyBullet has room for some thousand clients; those of worlds that nobody closes must not fill it.
        self.close = weakref.finalize(self, bullet.disconnect, physicsClientId=self.client)
        self._substeps = substeps(options.step, options.control_period)
        self.period = self._substeps * options.step
        self._dof = len(arm.joints)
        self._finger_efforts = [joint.effort for joint in arm.fingers.joints]
        self._most = np.array([joint.effort for joint in arm.joints])
        self._efforts: list[float] = []
        self._gains = [min(options.joint_gain * options.step, 1.0)] * (self._dof + 2)
        self._ones = [1.0] * (self._dof + 2)
        self._way: list[list[float]] = []
        self._speeds: list[float] = []
        self._damped: list[float] | None = None
        self._complied = 0
        self._steps = 0
        self._points: list[Any] = []
        self._pairs: dict[tuple[int, int], ContactPair] = {}
        self._seen: ObjectReading | None = None

    def place(self, placement: Placement) -> None:
        """Build the whole world anew."""
        o, client = self._options, self.client
        bullet.resetSimulation(physicsClientId=client)
        bullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=client)
        bullet.setPhysicsEngineParameter(fixedTimeStep=o.step, numSolverIterations=o.iterations, physicsClientId=client)
        self.bodies = build_shelf(client, self._scene, placement.poses, placement.spilled, o)
        self._rest = Rest(client, self._scene, self.bodies, o)
        self._rest.let_roll(placement.poses)
        self.loaded = load_arm(client, self._arm, self._base_pose, self._urdf, o)
        self.sags = sags(client, self.loaded)
        place_joints(client, self.loaded, self._arm, [*placement.joints.tolist(), *placement.fingers.tolist()])
        self.cap(self._most)
        self._stand_still([*placement.joints.tolist(), *placement.commanded_fingers.tolist()])
        self._points, self._pairs, self._steps, self._seen = [], {}, 0, None

    def arm(self) -> ArmReading:
        """The arm as it is now."""
        link = bullet.getLinkState(
            self.loaded.body, self.loaded.tip, computeForwardKinematics=True, physicsClientId=self.client
        )
        (x, y, z), (qx, qy, qz, qw) = link[4:6]
        states, dof = self._states(self.loaded.joints), self._dof
        values = np.array([state[0] for state in states])
        return ArmReading(
            joints=values[:dof],
            fingers=values[dof:],
            commanded_fingers=np.array(self._way[-1][dof:]),
            gripper=seen_from_above((x, y, z, qw, qx, qy, qz)),
            efforts=np.abs([state[3] for state in states[:dof]]),
            inertias=self._inertias(),
        )

    def objects(self) -> ObjectReading:
        """The objects as they are now; if the step just made has looked at them, as that has seen them."""
        seen, self._seen = self._seen, None
        return seen or self._read_objects()

    def _read_objects(self) -> ObjectReading:
        poses, velocities = np.zeros((len(self._scene.objects), 7)), np.zeros((len(self._scene.objects), 6))
        for row, body in self.bodies.objects.items():
            (x, y, z), (qx, qy, qz, qw) = bullet.getBasePositionAndOrientation(body, physicsClientId=self.client)
            straight, turning = bullet.getBaseVelocity(body, physicsClientId=self.client)
            poses[row], velocities[row] = (x, y, z, qw, qx, qy, qz), (*straight, *turning)
        return ObjectReading(poses, velocities)

    def contacts(self) -> Iterator[EngineContact]:
        """The arm's contacts with anything else, told by links and bodies."""
        pairs = self._pairs
        for point in self._points:
            touching, (x, y, z) = (point[3], point[2]), point[7]
            pair = pairs.get(touching) or pairs.setdefault(touching, self._pair(*touching))
            yield pair, (-x, -y, -z)

    def _pair(self, link: int, body: int) -> ContactPair:
        loaded, bodies = self.loaded, self.bodies
        return ContactPair(
            loaded.parts[link],
            bodies.names[body],
            body in bodies.walls,
            bodies.rows.get(body),
            loaded.sides.get(link, 0),
        )

    def trouble(self) -> str | None:
        """That the arm is nowhere."""
        numbers = sum(state[0] + state[1] for state in self._states(self.loaded.movable))
        return None if math.isfinite(numbers) else "the arm is nowhere; try a smaller backend step"

    def controls(self, positions: FloatArray, velocities: FloatArray, fingers: FloatArray) -> list[Any]:
        """Where arm and fingers are to be after each step ``(dof + 2,)``, and how fast, of ``k`` control steps."""
        speeds = np.hstack([velocities, np.zeros_like(fingers)])
        ahead = self._options.step * np.arange(self._substeps - 1, -1, -1)[:, None]
        ways = np.hstack([positions, fingers])[:, None] - ahead * speeds[:, None]
        return list(zip(ways.tolist(), speeds.tolist(), strict=True))

    def command(self, control: Any) -> None:
        """Tell the motors where to be and how fast, in the next steps."""
        (self._way, self._speeds), self._damped, self._complied = control, None, 0

    def cap(self, efforts: FloatArray) -> None:
        """Let the arm's joints give no more than this ``(dof,)`` (N or Nm), from the next command on."""
        self._efforts = [*efforts.tolist(), *self._finger_efforts]

    def comply(self) -> None:
        """Let the motors, which are rigid, give no more than it takes to slow the arm down: M qd / t in every joint."""
        states = self._states(self.loaded.joints[: self._dof])
        complied = self._complied + 1  # the longer it complies, the less is left to slow down
        slowing = self._inertias() * np.abs([state[1] for state in states]) / SLOWING
        self._stand_still([*(state[0] for state in states), *self._way[-1][self._dof :]])
        given = np.minimum((slowing + COMPLIANT_EFFORT * self._most) / complied, self._efforts[: self._dof])
        self._complied = complied
        self._damped = [*given.tolist(), *self._finger_efforts]

    def advance(self) -> Progress:
        """Let one control step pass. The hot path."""
        arm, client = self.loaded, self.client
        forces, weight = self._damped or self._efforts, self._weight() if self.sags else None
        for place in self._way:
            bullet.setJointMotorControlArray(
                arm.body,
                arm.joints,
                bullet.POSITION_CONTROL,
                targetPositions=place,
                targetVelocities=self._speeds,
                forces=forces,
                positionGains=self._gains,
                velocityGains=self._ones,
                physicsClientId=client,
            )
            if weight is not None:  # forgotten after every step
                bullet.setJointMotorControlArray(
                    arm.body, arm.movable, bullet.TORQUE_CONTROL, forces=weight, physicsClientId=client
                )
            bullet.stepSimulation(physicsClientId=client)
        x, y, _ = bullet.getLinkState(arm.body, arm.tip, physicsClientId=client)[4]
        points = bullet.getContactPoints(bodyA=arm.body, physicsClientId=client)
        self._points = [point for point in points if point[9] > 0.0 or point[8] <= NEAR] if points else []
        self._steps = steps = self._steps + 1
        self._seen = None
        if steps % LOOK == 0:
            self._seen = self._read_objects()
            self._rest.look(self._seen)
        return x, y, len(self._points), self._net_force() if self._points else 0.0

    def remove(self, row: int) -> None:
        """Remove an object's body."""
        bullet.removeBody(self.bodies.objects.pop(row), physicsClientId=self.client)

    def set_held(self, row: int, *, held: bool) -> None:
        """Let an object meet the boxes that are board and walls, which end at the mouth, or the planes."""
        set_held(self.client, self._scene, self.bodies, row, self._options, held=held)

    @contextmanager
    def running(self) -> Iterator[None]:
        """See what is at rest as a run goes on, and at its end."""
        self._steps = 0
        yield
        self._rest.look(self.objects())

    def memory(self) -> FloatArray:
        """Velocities of the objects ``(6n,)``, then of the arm's joints and the two fingers ``(dof + 2,)``."""
        speeds = [state[1] for state in self._states(self.loaded.joints)]
        return np.concatenate([self.objects().velocities.ravel(), speeds])

    def recall(self, memory: FloatArray) -> None:
        """Give everything its speed again; what Bullet remembers of its contacts is lost."""
        velocities, speeds = np.split(memory, [6 * len(self._scene.objects)])
        for row, body in self.bodies.objects.items():
            straight, turning = (
                velocities[6 * row : 6 * row + 3].tolist(),
                velocities[6 * row + 3 : 6 * row + 6].tolist(),
            )
            bullet.resetBaseVelocity(body, straight, turning, physicsClientId=self.client)
        values = [state[0] for state in self._states(self.loaded.joints)]
        for joint, value, speed in zip(self.loaded.joints, values, speeds.tolist(), strict=True):
            bullet.resetJointState(self.loaded.body, joint, value, speed, physicsClientId=self.client)

    def _stand_still(self, values: list[float]) -> None:
        """Tell arm and fingers to stand still at joint values ``(dof + 2,)``."""
        self.command(([values] * self._substeps, [0.0] * len(values)))

    def _net_force(self) -> float:
        """On the arm, of all its contacts (N): the sum of normal forces and friction, as vectors."""
        x = y = z = 0.0
        for point in self._points:
            for size, direction in ((point[9], point[7]), (point[10], point[11]), (point[12], point[13])):
                x, y, z = x + size * direction[0], y + size * direction[1], z + size * direction[2]
        return math.sqrt(x * x + y * y + z * z)

    def _weight(self) -> Any:
        """What the joints have to give, besides what their motors do, so that the arm does not sag."""
        return weight(self.client, self.loaded, [state[0] for state in self._states(self.loaded.movable)])

    def _inertias(self) -> FloatArray:
        values = [state[0] for state in self._states(self.loaded.movable)]
        return inertias(self.client, self.loaded, values)[: self._dof]

    def _states(self, joints: tuple[int, ...]) -> Any:
        return bullet.getJointStates(self.loaded.body, joints, physicsClientId=self.client)
