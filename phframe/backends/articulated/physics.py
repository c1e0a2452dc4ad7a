"""Physics of engines that move an arm by its joints: an engine, and what all of them have in common around it."""

from __future__ import annotations

from typing import Annotated, ClassVar, TypeVar

import numpy as np
from pydantic import Field

from phframe.backends.articulated.drive import JointDrive
from phframe.backends.articulated.engine import JointEngine
from phframe.backends.articulated.world import ArticulatedSnapshot, ArticulatedWorld
from phframe.core import (
    ArmError,
    ArmState,
    FloatArray,
    GripperTrajectory,
    JointTrajectory,
    Motion,
    Options,
    Phase,
    Physics,
    Settle,
    State,
    Stop,
    Trajectory,
    Watch,
)

Coefficient = Annotated[float, Field(ge=0.0, le=2.0)]
"""Of Coulomb friction."""
SAMPLE = 0.02
"""Time between the joint samples of a twist that is held (s)."""


class JointEngineOptions(Options):
    """What these engines have in common.

    Attributes:
        step: Time step (s).
        control_period: Between commands to the joints, and between looks at what the arm touches (s).
        sleep: Whether what is at rest is left out until something touches it; several times faster.
        object_friction: Coulomb coefficient between objects.
        arm_friction: Coulomb coefficient between the arm and all else.
        turning_friction: Of a contact against turning on the spot (m).
        rolling_friction: Of a contact against rolling (m).
        stall_lag: How far the fingertip may fall behind its trajectory before it counts as stalled (m).
    """

    step: Annotated[float, Field(gt=0.0, le=0.005)] = 0.002
    control_period: Annotated[float, Field(gt=0.0, le=0.02)] = 0.004
    sleep: bool = True
    object_friction: Coefficient = 0.2
    arm_friction: Coefficient = 0.3
    turning_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.005
    rolling_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.0005
    stall_lag: Annotated[float, Field(gt=0.0, le=0.2)] = 0.015


OptionsT = TypeVar("OptionsT", bound=JointEngineOptions)


class ArticulatedPhysics(Physics[OptionsT]):
    """Physics with an engine of joints.

    A backend names its options and its engine, and writes no method::

        class MyPhysics(ArticulatedPhysics[MyOptions]):
            options_type = MyOptions
            engine_type = MyEngine

    Attributes:
        engine_type: The engine's class.
    """

    executes = JointTrajectory
    engine_type: ClassVar[type[JointEngine]]
    _made: ArticulatedWorld | None = None

    @property
    def world(self) -> ArticulatedWorld:
        """The world as it is now; the scene as written, if nothing has been restored yet."""
        if self._made is None:
            self.restore(self.scene.initial_state())
        assert self._made is not None
        return self._made

    def restore(self, state: State) -> State:
        """Put everything where ``state`` has it, at rest."""
        world = self._made or self._new_world()
        world.restore(state)
        self._made = world
        return world.read_state()

    def _new_world(self) -> ArticulatedWorld:
        engine = self.engine_type(self.scene, self.arm, self.base_pose, self.options)
        return ArticulatedWorld(self.scene, self.arm, self.base_pose, engine)

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        """Drive the joints along a trajectory.

        Raises:
            InputError: If it is not a ``JointTrajectory``, begins elsewhere or is beyond the joints' limits.
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """
        drive = JointDrive(self.world, trajectory, stall_lag=self.options.stall_lag, stop=stop, watch=watch)
        return drive.run(settle)

    def observe(self) -> State:
        """The world as it is now."""
        return self.world.read_state()

    def snapshot(self) -> ArticulatedSnapshot:
        """The world as it is now, moving or not."""
        return self.world.snapshot()

    def state_of(self, snapshot: ArticulatedSnapshot) -> State:
        """What a snapshot holds, its speeds aside."""
        return snapshot.state

    def propagate(
        self,
        snapshot: ArticulatedSnapshot,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[ArticulatedSnapshot, Motion]:
        """Hold a fingertip twist for ``dt`` seconds, without settling; see ``SupportsPropagation``.

        Raises:
            ArmError: If the arm is parked, or cannot follow.
        """
        arm = snapshot.state.arm
        if arm is None:
            raise ArmError("a parked arm cannot be propagated: give a state in which it stands somewhere")
        self.world.put_back(snapshot)
        motion = self.execute(_held_twist(self.world, arm, twist, dt, opening), settle=None, stop=stop)
        return self.world.snapshot(), motion

    def close(self) -> None:
        """Give the engine's memory back."""
        if self._made is not None:
            self._made.engine.close()
        self._made = None


def _held_twist(
    world: ArticulatedWorld, arm: ArmState, twist: FloatArray, dt: float, opening: float | None
) -> JointTrajectory:
    """The trajectory of joints that keeps a fingertip twist ``(3,)`` for ``dt`` seconds."""
    assert arm.joints is not None, "a snapshot of a world of joints has them"
    times = np.linspace(0.0, dt, max(2, round(dt / SAMPLE) + 1))
    poses = arm.gripper + times[:, None] * np.asarray(twist)
    told = arm.commanded_opening
    openings = np.linspace(told, told if opening is None else opening, len(times))
    gripper = GripperTrajectory(times, poses, openings, (Phase.SWEEP,) * (len(times) - 1), world.arm.force_limit)
    joints = [arm.joints]
    for pose in poses[1:]:
        joints.append(world.joints_at(pose, joints[-1]))
    return JointTrajectory(gripper, np.array(joints), np.gradient(joints, times, axis=0))
