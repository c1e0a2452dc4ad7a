"""Physics in space with MuJoCo: board, walls, ceiling, objects that may tip, roll and fall, an arm moved by its joints.

The arm is its own URDF, held by a position servo on every joint that gives no more than the joint's real effort; it is
never put anywhere by hand while it can touch something. What it holds, it holds by friction alone. A force on the arm
above the trajectory's limit stalls it; it then gives way until nothing presses on it. An object that leaves the board is
spilled, and is taken out of the world.

MuJoCo's elliptic friction cone and a step of 2 ms keep the published scenes at rest; objects sink 0.1 mm into the board.
"""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Literal

import mujoco
from pydantic import Field

from phframe.backends.mujoco_drive import Drive
from phframe.backends.mujoco_model import Controls, Model, build_model
from phframe.backends.mujoco_shelf import Surfaces
from phframe.backends.mujoco_snapshot import Snapshot, held_twist, put_back, take_snapshot
from phframe.backends.mujoco_world import World, read_state, restore
from phframe.core import (
    ArmError,
    FloatArray,
    JointTrajectory,
    Motion,
    Options,
    Physics,
    Settle,
    State,
    Stop,
    Trajectory,
    Watch,
)

Coefficient = Annotated[float, Field(ge=0.0, le=2.0)]


class MujocoOptions(Options):
    """Options of the MuJoCo backend.

    Attributes:
        step: Time step (s).
        cone: Of friction: ``elliptic`` is Coulomb's, ``pyramidal`` an approximation.
        friction_firmness: Stiffness of friction over that of contact (MuJoCo's impratio): less creep in the hand.
        sleep: Whether what is at rest is passed over until something touches it; several times faster.
        object_friction: Coulomb coefficient between objects.
        arm_friction: Coulomb coefficient between the arm and all else.
        turning_friction: Of a contact against turning on the spot (m).
        rolling_friction: Of a contact against rolling (m).
        joint_give: Error at which a joint of the arm gives its whole effort (rad or m).
        finger_give: The same of a finger (m).
        stall_lag: How far the fingertip may fall behind its trajectory before it counts as stalled (m).
    """

    step: Annotated[float, Field(gt=0.0, le=0.005)] = 0.002
    cone: Literal["elliptic", "pyramidal"] = "elliptic"
    friction_firmness: Annotated[float, Field(ge=1.0, le=100.0)] = 3.0
    sleep: bool = True
    object_friction: Coefficient = 0.2
    arm_friction: Coefficient = 0.3
    turning_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.005
    rolling_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.0005
    joint_give: Annotated[float, Field(gt=0.0, le=0.2)] = 0.01
    finger_give: Annotated[float, Field(gt=0.0, le=0.05)] = 0.002
    stall_lag: Annotated[float, Field(gt=0.0, le=0.2)] = 0.015


class MujocoPhysics(Physics[MujocoOptions]):
    """MuJoCo 4 behind the Physics interface.

    ``restore`` resets the engine's data completely, warm starts and sleep included, so ``simulate`` repeats bit by bit.
    """

    options_type = MujocoOptions
    executes = JointTrajectory
    _world: World | None = None

    def restore(self, state: State) -> State:
        """Put everything where ``state`` has it, at rest."""
        world = self._world or World(self.model, mujoco.MjData(self.model.mj))
        restore(world, state)
        self._world = world
        return read_state(world)

    @cached_property
    def model(self) -> Model:
        """The compiled model, made when it is first needed."""
        o = self.options
        surfaces = Surfaces(o.object_friction, o.turning_friction, o.rolling_friction, o.cone, o.friction_firmness)
        controls = Controls(o.joint_give, o.finger_give, o.arm_friction)
        return build_model(self.scene, self.arm, self.mount, surfaces, controls, step=o.step, sleep=o.sleep)

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        """Drive the joints along a trajectory.

        Raises:
            InputError: If it is not a ``JointTrajectory``, begins elsewhere or is beyond the joints' limits.
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """
        drive = Drive(self._current, trajectory, stall_lag=self.options.stall_lag, stop=stop, watch=watch)
        return drive.run(settle)

    def observe(self) -> State:
        """The world as it is now."""
        return read_state(self._current)

    def snapshot(self) -> Snapshot:
        """The world as it is now, moving or not."""
        return take_snapshot(self._current)

    def state_of(self, snapshot: Snapshot) -> State:
        """What a snapshot holds, its speeds aside."""
        return snapshot.state

    def propagate(
        self,
        snapshot: Snapshot,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[Snapshot, Motion]:
        """Hold a fingertip twist for ``dt`` seconds, without settling; see ``SupportsPropagation``.

        Raises:
            ArmError: If the arm is parked, or cannot follow.
        """
        if snapshot.state.arm is None:
            raise ArmError("a parked arm cannot be propagated: give a state in which it stands somewhere")
        world = self._current
        put_back(world, snapshot)
        motion = self.execute(held_twist(world, snapshot, twist, dt, opening), settle=None, stop=stop)
        return take_snapshot(world), motion

    def close(self) -> None:
        """Drop the engine's data and model."""
        self._world = None
        self.__dict__.pop("model", None)

    @property
    def _current(self) -> World:
        if self._world is None:
            self.restore(self.scene.initial_state())
        assert self._world is not None
        return self._world
