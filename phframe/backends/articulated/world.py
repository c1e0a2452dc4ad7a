"""A world whose arm is moved by its joints: the bookkeeping between an engine and what a State says.

What has spilled, what is held and whether the arm is parked is kept here, once for all engines.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike

from phframe.backends.articulated.engine import JointEngine, ObjectReading, Placement
from phframe.backends.contract import TOP_SPEED
from phframe.core import (
    ArmError,
    ArmModel,
    ArmState,
    BasePose,
    Condition,
    FloatArray,
    Floats,
    InputError,
    Scene,
    SimulationDivergedError,
    State,
    Value,
    condition_of,
    refuse_foreign,
)


@dataclass(frozen=True, slots=True, eq=False)
class ArticulatedSnapshot(Value):
    """A world caught in motion, for planners that steer at control level.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        memory: The engine's own account of speeds and whatever else its next step depends on ``(m,)``.
    """

    state: State
    memory: Floats

    def __post_init__(self) -> None:
        self._freeze("memory")


@final
class ArticulatedWorld:
    """A world at some moment.

    Args:
        scene: What is in it.
        arm: In it.
        base_pose: Of the arm.
        engine: That moves it.

    Attributes:
        spilled: Last pose seen ``(7,)``, by row of the object.
        held: Row of the object in the hand.
        parked: The arm stands at home and has not been used yet.
    """

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, engine: JointEngine) -> None:
        self.scene, self.arm, self.base_pose, self.engine = scene, arm, base_pose, engine
        self.spilled: dict[int, FloatArray] = {}
        self.held: int | None = None
        self.parked = True
        self._closed = np.array([joint.lower for joint in arm.fingers.joints])
        self._least = arm.shape.min_opening
        self._radii = scene.radii
        # A velocity of which no component is greater than this is below TOP_SPEED, its rim's part included.
        self._slow = TOP_SPEED / (np.sqrt(3.0) * (1.0 + float(self._radii.max(initial=0.0))))

    @property
    def squeeze(self) -> float:
        """How much closer the fingers are told to be than they are (m)."""
        arm = self.engine.arm()
        return self._opening(arm.fingers) - self._opening(arm.commanded_fingers)

    def _opening(self, fingers: FloatArray) -> float:
        return self._least + float((fingers - self._closed).sum())

    @property
    def speeds(self) -> FloatArray:
        """Speed of every object ``(n,)``, that of its rim included (m/s); 0 of what has spilled."""
        return self._speeds(self.engine.objects().velocities)

    def _speeds(self, velocities: FloatArray) -> FloatArray:
        straight, turning = np.linalg.norm(velocities[:, :3], axis=1), np.linalg.norm(velocities[:, 3:], axis=1)
        speeds = straight + turning * self._radii
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
        fingers, told_fingers = self.finger_values(opening), self.finger_values(told)
        self.engine.place(Placement(state.poses, frozenset(self.spilled), joints, fingers, told_fingers))
        self.hold(None if state.held is None else self.scene.index(state.held))
        self.parked = arm is None

    def snapshot(self) -> ArticulatedSnapshot:
        """The world as it is now, moving or not."""
        state = self.read_state()
        return ArticulatedSnapshot(state, self.engine.memory())

    def put_back(self, snapshot: ArticulatedSnapshot) -> None:
        """Make the world be what it was when a snapshot was taken, as far as the engine can."""
        self.restore(snapshot.state)
        self.engine.recall(snapshot.memory)

    def hold(self, row: int | None) -> None:
        """Note what is held."""
        if self.held is not None and self.held not in self.spilled:
            self.engine.set_held(self.held, held=False)
        if row is not None:
            self.engine.set_held(row, held=True)
        self.held = row

    def stand_still(self, positions: FloatArray) -> None:
        """Tell the arm to stand still at joint values ``(dof,)``; the fingers go on as told."""
        engine, fingers = self.engine, self.engine.arm().commanded_fingers
        engine.command(engine.controls(positions[None], np.zeros((1, len(positions))), fingers[None])[0])

    def survey(self) -> None:
        """Look at everything: refuse what is no physics any more, take out what has left the board.

        Raises:
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """
        objects = self.engine.objects()
        self._refuse_divergence(objects)
        x, _, z, *_ = objects.poses.min(axis=0, initial=0.0).tolist()
        if x < 0.0 or z < 0.0:
            self._spill(objects.poses)

    def _spill(self, poses: FloatArray) -> None:
        """Take out what has left the board, at poses ``(n, 7)``; the pose it was last seen at is kept."""
        for row in np.flatnonzero((poses[:, 0] < 0.0) | (poses[:, 2] < 0.0)).tolist():
            held = row == self.held
            if row not in self.spilled and condition_of(poses[row], held=held) is Condition.SPILLED:
                self.spilled[row] = np.array(poses[row])
                self.engine.remove(row)

    def refuse_divergence(self) -> None:
        """Raise where a body is nowhere or faster than physics allows, or the engine itself complains.

        Raises:
            SimulationDivergedError: With the object and its speed, or the complaint.
        """
        self._refuse_divergence(self.engine.objects())

    def _refuse_divergence(self, objects: ObjectReading) -> None:
        velocities = objects.velocities
        if (
            not max(velocities.max(initial=0.0), -velocities.min(initial=0.0)) < self._slow
        ):  # nothing that is not a number is less
            self._refuse_fast(self._speeds(velocities))
        if (trouble := self.engine.trouble()) is not None:
            raise SimulationDivergedError(f"the simulation diverged: {trouble}")

    def _refuse_fast(self, speeds: FloatArray) -> None:
        for row in np.flatnonzero(~(speeds < TOP_SPEED)).tolist():
            what = f"{self.scene.ids[row]!r} moves at {speeds[row]:.3g} m/s"
            raise SimulationDivergedError(f"the simulation diverged: {what}; try a smaller backend step")

    def read_state(self) -> State:
        """The world as it is now."""
        poses = np.array(self.engine.objects().poses)
        conditions = [condition_of(pose, held=row == self.held) for row, pose in enumerate(poses)]
        for row, pose in self.spilled.items():
            poses[row], conditions[row] = pose, Condition.SPILLED
        held = None if self.held is None else self.scene.ids[self.held]
        return State(poses, tuple(conditions), held, None if self.parked else self._arm_state())

    def _arm_state(self) -> ArmState:
        arm = self.engine.arm()
        return ArmState(arm.gripper, self._opening(arm.fingers), self._opening(arm.commanded_fingers), arm.joints)

    def _joints_of(self, arm: ArmState | None) -> FloatArray:
        if arm is None:
            return np.asarray(self.arm.home)
        if arm.joints is not None:
            if arm.joints.shape != (len(self.arm.joints),):
                raise InputError(f"a state's arm has {len(arm.joints)} joints, this one {len(self.arm.joints)}")
            return arm.joints
        return self.joints_at(arm.gripper, None)

    def joints_at(self, gripper: FloatArray, seed: FloatArray | None) -> FloatArray:
        """Joint values ``(dof,)``, near others, for a fingertip pose ``(3,)`` in the shelf frame.

        Raises:
            ArmError: If there are none.
        """
        found = self.arm.inverse(self.arm.fingertip_pose(gripper, self.base_pose), seed)
        if found is None:
            x, y, yaw = gripper.tolist()
            raise ArmError(f"the arm cannot have its fingertip at x {x:.3f} m, y {y:.3f} m, yaw {yaw:.2f} rad")
        return found
