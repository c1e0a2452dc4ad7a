"""A world in space whose arm is moved by its joints: what every engine of the kind has in common.

An engine knows bodies and joints. What it does not know is kept here: what has spilled, what is held, whether the arm
still stands at home, and how all that and the engine's numbers make up a ``State``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import (
    ArmModel,
    ArmState,
    BasePose,
    Condition,
    FloatArray,
    InputError,
    Scene,
    SimulationDivergedError,
    State,
    compose,
    condition_of,
    inverse,
    planar_pose,
    refuse_foreign,
)

CONTROL_PERIOD = 0.004
"""Between commands to the joints, and between looks at what the arm touches (s)."""
TOP_SPEED = 20.0
"""Anything faster (m/s) is not physics any more."""

Pair = tuple[int, int]
"""A part of the arm and what it touches, by the engine's numbers."""
Vector = tuple[float, float, float]
Progress = tuple[float, float, float, float]
"""After a control step: x and y of the fingertip (m), number of contacts of the arm, net force of those on it (N)."""


class JointWorld(ABC):
    """A world at some moment.

    Args:
        scene: What is in it.
        arm: In it.
        base_pose: Of the arm.
        step: The engine's time step (s).

    Attributes:
        step: The engine's time step (s).
        substeps: Steps in a control step.
        period: Duration of a control step (s).
        delay: How old the fingertip's place is that ``advance`` tells (s).
        spilled: Last pose seen, by row of the object.
        held: Row of the object in the hand.
        parked: The arm stands at home and has not been used yet.
    """

    engine: ClassVar[str]
    """The backend's name, for messages."""
    delay: float = 0.0

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, step: float) -> None:
        self.step, self.substeps = step, max(1, round(CONTROL_PERIOD / step))
        self.period = self.substeps * step
        self.scene, self.arm, self.base_pose = scene, arm, base_pose
        self.spilled: dict[int, FloatArray] = {}
        self.held: int | None = None
        self.parked = True
        self._closed = np.array([joint.lower for joint in arm.fingers.joints])
        self._least = arm.shape.min_opening

    # What an engine tells.

    @property
    @abstractmethod
    def joints(self) -> FloatArray:
        """Joint values ``(dof,)``."""

    @property
    @abstractmethod
    def fingers(self) -> FloatArray:
        """What the two finger joints are ``(2,)``."""

    @property
    @abstractmethod
    def told_fingers(self) -> FloatArray:
        """What the two finger joints are told to be ``(2,)``."""

    @property
    @abstractmethod
    def gripper(self) -> FloatArray:
        """Fingertip pose ``(3,)`` in the shelf frame."""

    @property
    @abstractmethod
    def object_poses(self) -> FloatArray:
        """Pose of every object ``(n, 7)``, anything for those that have spilled."""

    @property
    @abstractmethod
    def velocities(self) -> FloatArray:
        """Velocity of every object ``(n, 6)``, straight (m/s) and turning (rad/s), anything for those that have spilled."""

    @property
    @abstractmethod
    def inertias(self) -> FloatArray:
        """What each of the arm's joints has to accelerate ``(dof,)`` (kg or kg m^2)."""

    @property
    @abstractmethod
    def given(self) -> FloatArray:
        """Magnitude of the force or torque that each of the arm's joints gave in the last step ``(dof,)``."""

    @property
    @abstractmethod
    def trouble(self) -> str | None:
        """Why the engine's numbers are no longer physical, besides objects that are too fast, or None."""

    @abstractmethod
    def touching(self) -> Iterator[Pair]:
        """The arm's contacts with anything else."""

    @abstractmethod
    def names(self, pair: Pair) -> tuple[str, str, bool]:
        """The part of the arm, what it touches, whether that is a wall."""

    @abstractmethod
    def pushes(self) -> Iterator[tuple[int, int, Vector]]:
        """Of every contact of a finger with an object: the object's row, the finger (+1 or -1), its direction."""

    # What an engine does.

    @abstractmethod
    def controls(self, positions: FloatArray, velocities: FloatArray, fingers: FloatArray) -> list[Any]:
        """What ``tell`` is given at each of ``k`` control steps, for joints and speeds ``(k, dof)``, fingers ``(k, 2)``."""

    @abstractmethod
    def tell(self, control: Any) -> None:
        """Tell arm and fingers where to be, one of ``controls``."""

    @abstractmethod
    def hold_joints(self, positions: FloatArray) -> None:
        """Tell the arm to stand still at joint values ``(dof,)``; the fingers go on as told."""

    @abstractmethod
    def comply(self) -> None:
        """Ask nothing of the arm but to lose its speed where it is, and to let what presses on it push it back."""

    @abstractmethod
    def cap(self, efforts: FloatArray) -> None:
        """Let the arm's joints give no more than this ``(dof,)`` (N or Nm)."""

    @abstractmethod
    def advance(self) -> Progress:
        """Let one control step pass."""

    @abstractmethod
    def _place(self, state: State, joints: FloatArray, fingers: FloatArray, told_fingers: FloatArray) -> None:
        """Put everything in its place, at rest, without what is in ``spilled``; all objects stand on the whole board."""

    @abstractmethod
    def _remove(self, row: int) -> None:
        """Take an object out of the world."""

    @abstractmethod
    def _stand(self, row: int, *, on_edge: bool) -> None:
        """Let an object stand on a board that ends at the mouth, or on one that does not."""

    @contextmanager
    def running(self) -> Iterator[None]:
        """What an engine needs around a run."""
        yield

    # What follows from that.

    @property
    def opening(self) -> float:
        """Distance between the fingers (m)."""
        return self._least + float((self.fingers - self._closed).sum())

    @property
    def command(self) -> float:
        """The distance between the fingers that they are told to have (m)."""
        return self._least + float((self.told_fingers - self._closed).sum())

    @property
    def speeds(self) -> FloatArray:
        """Speed of every object ``(n,)``, that of its rim included (m/s); 0 of what has spilled."""
        velocity = self.velocities
        speeds = np.linalg.norm(velocity[:, :3], axis=1) + np.linalg.norm(velocity[:, 3:], axis=1) * self.scene.radii
        speeds[list(self.spilled)] = 0.0
        return np.asarray(speeds)

    def finger_values(self, openings: ArrayLike) -> FloatArray:
        """What the two finger joints are ``(..., 2)`` at openings ``(...)`` (m)."""
        travel = (np.asarray(openings) - self._least) / 2.0
        return np.asarray(self._closed + travel[..., None])

    def restore(self, state: State) -> None:
        """Make the world be a state, at rest.

        Raises:
            InputError: If the state is not one of this scene and this arm.
        """
        shape, arm = self.arm.shape, state.arm
        refuse_foreign(self.scene, shape, state)
        joints = self._joints_of(arm)
        opening, told = (shape.min_opening, shape.min_opening) if arm is None else (arm.opening, arm.commanded_opening)
        self.held = None
        self.spilled = {int(row): np.array(state.poses[row]) for row in np.flatnonzero(~state.on_board)}
        self._place(state, joints, self.finger_values(opening), self.finger_values(told))
        self.hold(None if state.held is None else self.scene.index(state.held))
        self.parked = arm is None

    def hold(self, row: int | None) -> None:
        """Note what is held; what is held stands on a board that ends at the mouth, all else on one that does not."""
        if self.held is not None and self.held not in self.spilled:
            self._stand(self.held, on_edge=False)
        if row is not None:
            self._stand(row, on_edge=True)
        self.held = row

    def survey(self) -> None:
        """Look at everything: refuse what is no physics any more, take out what has left the board.

        Raises:
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """
        self.refuse_divergence()
        self.spill(self.object_poses)

    def spill(self, object_poses: FloatArray) -> None:
        """Take out what has left the board, at poses ``(n, 7)``; the pose it was last seen at is kept."""
        for row in np.flatnonzero((object_poses[:, 0] < 0.0) | (object_poses[:, 2] < 0.0)).tolist():
            held = row == self.held
            if row not in self.spilled and condition_of(object_poses[row], held=held) is Condition.SPILLED:
                self.spilled[row] = np.array(object_poses[row])
                self._remove(row)

    def refuse_divergence(self) -> None:
        """Raise where a body is nowhere or faster than physics allows, or the engine itself complains.

        Raises:
            SimulationDivergedError: With the object and its speed, or the complaint.
        """
        self._refuse(self.speeds)

    def _refuse(self, speeds: FloatArray) -> None:
        if not (speeds < TOP_SPEED).all():  # nothing that is not a number is less
            row = int(np.flatnonzero(~(speeds < TOP_SPEED))[0])
            what = f"{self.scene.ids[row]!r} moves at {speeds[row]:.3g} m/s"
            raise SimulationDivergedError(f"the simulation diverged: {what}; try a smaller backend step")
        if (trouble := self.trouble) is not None:
            raise SimulationDivergedError(f"the simulation diverged: {trouble}")

    def read_state(self) -> State:
        """The world as it is now."""
        poses = np.array(self.object_poses)
        conditions = [condition_of(pose, held=row == self.held) for row, pose in enumerate(poses)]
        for row, pose in self.spilled.items():
            poses[row], conditions[row] = pose, Condition.SPILLED
        held = None if self.held is None else self.scene.ids[self.held]
        return State(poses, tuple(conditions), held, None if self.parked else self._arm_state())

    def _arm_state(self) -> ArmState:
        return ArmState(self.gripper, self.opening, self.command, self.joints)

    def _joints_of(self, arm: ArmState | None) -> FloatArray:
        if arm is None:
            return np.asarray(self.arm.home)
        if arm.joints is not None:
            if arm.joints.shape != (len(self.arm.joints),):
                raise InputError(f"a state's arm has {len(arm.joints)} joints, this one {len(self.arm.joints)}")
            return arm.joints
        x, y, yaw = (float(value) for value in arm.gripper)
        wanted = planar_pose(x, y, self.arm.shape.height, yaw)
        found = self.arm.inverse(compose(inverse(self.base_pose.pose), wanted))
        if found is None:
            raise InputError(f"the arm cannot have its fingertip at x {x:.3f} m, y {y:.3f} m, yaw {yaw:.2f} rad")
        return found
