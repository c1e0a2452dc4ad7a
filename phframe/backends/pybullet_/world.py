"""A PyBullet world: bodies in a client behind the abilities that every world of joints has."""

from __future__ import annotations

import math
import weakref
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from phframe.backends.articulated.world import JointWorld, Pair, Progress, Vector
from phframe.backends.pybullet_.arm import LoadedArm, load_arm
from phframe.backends.pybullet_.bodies import Surfaces
from phframe.backends.pybullet_.joints import inertias, place_joints, sags, weight
from phframe.backends.pybullet_.output_capture import bullet
from phframe.backends.pybullet_.shelf import Bodies, build_shelf, set_edge, stand
from phframe.backends.pybullet_.sleeping import Rest
from phframe.backends.pybullet_.urdf import PreparedUrdf
from phframe.core import ArmModel, BasePose, FloatArray, Scene, State, coulomb_with_board, yaw_of

GRAVITY = 9.81
NEAR = 1e-5
"""Bodies this close (m) touch, whether or not they press; Bullet tells of what is farther, too."""

SLOWING = 0.01
"""Time (s) in which an arm that complies loses its speed."""
YIELD = 0.02
"""Fraction of its effort that a joint keeps while the arm complies."""


@dataclass(frozen=True, slots=True)
class Engine:
    """How the engine is set.

    Attributes:
        step: Time step (s).
        iterations: Of the contact solver in a step.
        gain: Speed of a joint per error (1/s).
        surfaces: Friction.
        sleep: Whether what is at rest is passed over until something touches it.
    """

    step: float
    iterations: int
    gain: float
    surfaces: Surfaces
    sleep: bool


class World(JointWorld):
    """A world at some moment.

    Args:
        scene: What is in it.
        arm: In it.
        base_pose: Of the arm.
        urdf: Of the arm.
        engine: How the engine is set.

    Attributes:
        client: PyBullet's.
        close: Gives the client back; done by itself when the world is forgotten.
    """

    engine = "pybullet"
    _bodies: Bodies
    _loaded: LoadedArm
    _rest: Rest
    _sags: bool

    def __init__(
        self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, urdf: PreparedUrdf, engine: Engine
    ) -> None:
        super().__init__(scene, arm, base_pose, engine.step)
        self._settings, self._urdf = engine, urdf
        self.client: int = bullet.connect(bullet.DIRECT)
        # PyBullet has room for some thousand clients; those of worlds that nobody closes must not fill it.
        self.close = weakref.finalize(self, bullet.disconnect, physicsClientId=self.client)
        self._dof = len(arm.joints)
        self._finger_efforts = [joint.effort for joint in arm.fingers.joints]
        self._radii: list[float] = scene.radii.tolist()
        self._most = np.array([joint.effort for joint in arm.joints])
        self._efforts: list[float] = []
        self._gains = [min(engine.gain * engine.step, 1.0)] * (self._dof + 2)
        self._ones = [1.0] * (self._dof + 2)
        self._way: list[list[float]] = []
        self._speeds: list[float] = []
        self._damped: list[float] | None = None
        self._giving = 0
        self._points: list[Any] = []

    @property
    def joints(self) -> FloatArray:
        """Joint values ``(dof,)``."""
        return np.array(self._values()[: self._dof])

    @property
    def fingers(self) -> FloatArray:
        """What the two finger joints are ``(2,)``."""
        return np.array(self._values()[self._dof :])

    @property
    def told_fingers(self) -> FloatArray:
        """What the two finger joints are told to be ``(2,)``."""
        return np.array(self._way[-1][self._dof :])

    @property
    def gripper(self) -> FloatArray:
        """Fingertip pose ``(3,)`` in the shelf frame."""
        link = bullet.getLinkState(
            self._loaded.body, self._loaded.tip, computeForwardKinematics=True, physicsClientId=self.client
        )
        (x, y, z), (qx, qy, qz, qw) = link[4:6]
        return np.array([x, y, yaw_of((x, y, z, qw, qx, qy, qz))])

    @property
    def object_poses(self) -> FloatArray:
        """Pose of every object ``(n, 7)``."""
        poses = np.zeros((len(self.scene.objects), 7))
        for row, body in self._bodies.objects.items():
            (x, y, z), (qx, qy, qz, qw) = bullet.getBasePositionAndOrientation(body, physicsClientId=self.client)
            poses[row] = x, y, z, qw, qx, qy, qz
        return poses

    @property
    def velocities(self) -> FloatArray:
        """Velocity of every object ``(n, 6)``, straight (m/s) and turning (rad/s)."""
        velocities = np.zeros((len(self.scene.objects), 6))
        for row, body in self._bodies.objects.items():
            straight, turning = bullet.getBaseVelocity(body, physicsClientId=self.client)
            velocities[row] = *straight, *turning
        return velocities

    @property
    def speeds(self) -> FloatArray:
        """As of every world; read often enough to be worth a loop of its own."""
        speeds = [0.0] * len(self._radii)
        for row, body in self._bodies.objects.items():
            straight, turning = bullet.getBaseVelocity(body, physicsClientId=self.client)
            speeds[row] = math.hypot(*straight) + math.hypot(*turning) * self._radii[row]
        return np.array(speeds)

    @property
    def inertias(self) -> FloatArray:
        """What each of the arm's joints has to accelerate ``(dof,)``, where it is."""
        values = [state[0] for state in self._states(self._loaded.movable)]
        return inertias(self.client, self._loaded, values)[: self._dof]

    @property
    def given(self) -> FloatArray:
        """Magnitude of the force or torque that each of the arm's joints gave in the last step ``(dof,)``."""
        return np.abs([state[3] for state in self._states(self._loaded.joints[: self._dof])])

    @property
    def trouble(self) -> str | None:
        """That the arm is nowhere."""
        numbers = sum(state[0] + state[1] for state in self._states(self._loaded.movable))
        return None if math.isfinite(numbers) else "the arm is nowhere; try a smaller backend step"

    def touching(self) -> Iterator[Pair]:
        """The arm's contacts with anything else: a link and a body."""
        return ((point[3], point[2]) for point in self._points)

    def names(self, pair: Pair) -> tuple[str, str, bool]:
        """The part of the arm, what it touches, whether that is a wall."""
        link, body = pair
        return self._loaded.parts[link], self._bodies.names[body], body in self._bodies.walls

    def pushes(self) -> Iterator[tuple[int, int, Vector]]:
        """Of every contact of a finger with an object: the object's row, the finger, its direction."""
        sides, rows = self._loaded.sides, self._bodies.rows
        for point in self._points:
            link, body = point[3], point[2]
            if link in sides and body in rows:
                x, y, z = point[7]
                yield rows[body], sides[link], (-x, -y, -z)

    def controls(self, positions: FloatArray, velocities: FloatArray, fingers: FloatArray) -> list[Any]:
        """Where arm and fingers are to be after each step ``(dof + 2,)``, and how fast, of ``k`` control steps."""
        speeds = np.hstack([velocities, np.zeros_like(fingers)])
        ahead = self.step * np.arange(self.substeps - 1, -1, -1)[:, None]
        ways = np.hstack([positions, fingers])[:, None] - ahead * speeds[:, None]
        return list(zip(ways.tolist(), speeds.tolist(), strict=True))

    def tell(self, control: Any) -> None:
        """Tell the motors where to be and how fast, in the next steps."""
        (self._way, self._speeds), self._damped, self._giving = control, None, 0

    def hold_joints(self, positions: FloatArray) -> None:
        """Tell the arm to stand still at joint values ``(dof,)``."""
        told = [*positions.tolist(), *self._way[-1][self._dof :]]
        self.tell(([told] * self.substeps, [0.0] * len(told)))

    def comply(self) -> None:
        """Let the motors, which are rigid, give no more than it takes to slow the arm down."""
        states = self._states(self._loaded.joints[: self._dof])
        fading = self._giving + 1  # the longer it complies, the less is left to slow down
        slowing = self.inertias * np.abs([state[1] for state in states]) / SLOWING
        self.hold_joints(np.array([state[0] for state in states]))
        given = np.minimum((slowing + YIELD * self._most) / fading, self._efforts[: self._dof])
        self._giving = fading
        self._damped = [*given.tolist(), *self._finger_efforts]

    def cap(self, efforts: FloatArray) -> None:
        """Let the arm's joints give no more than this ``(dof,)`` (N or Nm), from the next command on."""
        self._efforts = [*efforts.tolist(), *self._finger_efforts]

    def advance(self) -> Progress:
        """Let one control step pass. The hot path."""
        arm, client = self._loaded, self.client
        forces, weight = self._damped or self._efforts, self._weight() if self._sags else None
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
        return x, y, len(self._points), self._net_force() if self._points else 0.0

    @property
    def joint_speeds(self) -> FloatArray:
        """How fast the arm's joints and the two fingers move ``(dof + 2,)``."""
        return np.array([state[1] for state in self._states(self._loaded.joints)])

    def set_in_motion(self, velocities: FloatArray, joint_speeds: FloatArray) -> None:
        """Give objects ``(n, 6)`` and joints ``(dof + 2,)`` of a world that has just been restored their speeds."""
        for row, body in self._bodies.objects.items():
            straight, turning = velocities[row, :3].tolist(), velocities[row, 3:].tolist()
            bullet.resetBaseVelocity(body, straight, turning, physicsClientId=self.client)
        for joint, value, speed in zip(self._loaded.joints, self._values(), joint_speeds.tolist(), strict=True):
            bullet.resetJointState(self._loaded.body, joint, value, speed, physicsClientId=self.client)

    def survey(self) -> None:
        """Look at everything, and let what is at rest sleep."""
        object_poses, speeds = self.object_poses, self.speeds
        self._refuse(speeds)
        self.spill(object_poses)
        self._rest.look(object_poses, speeds)

    def _net_force(self) -> float:
        """On the arm, of all its contacts (N)."""
        x = y = z = 0.0
        for point in self._points:
            for size, direction in ((point[9], point[7]), (point[10], point[11]), (point[12], point[13])):
                x, y, z = x + size * direction[0], y + size * direction[1], z + size * direction[2]
        return math.sqrt(x * x + y * y + z * z)

    def _weight(self) -> Any:
        """What the joints have to give, besides what their motors do, so that the arm does not sag."""
        return weight(self.client, self._loaded, [state[0] for state in self._states(self._loaded.movable)])

    def _place(self, state: State, joints: FloatArray, fingers: FloatArray, told_fingers: FloatArray) -> None:
        """Build the whole world anew."""
        bullet.resetSimulation(physicsClientId=self.client)
        bullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=self.client)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=self._settings.step,
            numSolverIterations=self._settings.iterations,
            physicsClientId=self.client,
        )
        self._bodies = build_shelf(self.client, self.scene, state, self._settings.surfaces)
        self._rest = Rest(self.client, self.scene, self._bodies, self._settings.surfaces, sleep=self._settings.sleep)
        self._rest.let_roll(state.poses)
        self._loaded = load_arm(self.client, self.arm, self.base_pose, self._urdf, self._settings.surfaces)
        self._sags = sags(self.client, self._loaded)
        place_joints(self.client, self._loaded, self.arm, [*joints.tolist(), *fingers.tolist()])
        self._way = [[*joints.tolist(), *told_fingers.tolist()]]
        self.cap(self._most)
        self.hold_joints(joints)
        self._points = []

    def _remove(self, row: int) -> None:
        bullet.removeBody(self._bodies.objects.pop(row), physicsClientId=self.client)

    def _stand(self, row: int, *, on_edge: bool) -> None:
        body, bodies = self._bodies.objects[row], self._bodies
        friction = coulomb_with_board(self.scene, self.scene.objects[row])
        set_edge(self.client, bodies.edge, friction, self._settings.surfaces)
        stand(self.client, body, bodies.edge, stands=on_edge)
        stand(self.client, body, bodies.boards[row], stands=not on_edge)

    def _values(self) -> list[float]:
        return [state[0] for state in self._states(self._loaded.joints)]

    def _states(self, joints: tuple[int, ...]) -> Any:
        return bullet.getJointStates(self._loaded.body, joints, physicsClientId=self.client)
