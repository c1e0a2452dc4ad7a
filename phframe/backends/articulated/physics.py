"""What physics engines that move an arm by its joints have in common."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated, Generic, Protocol, TypeVar

from pydantic import Field

from phframe.backends.articulated.drive import Drive
from phframe.backends.articulated.held_twist import held_twist
from phframe.backends.articulated.world import JointWorld
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


class HasState(Protocol):
    """A snapshot."""

    @property
    def state(self) -> State:
        """Poses, conditions, what is held, the arm."""


class JointOptions(Options):
    """What these engines have in common.

    Attributes:
        step: Time step (s).
        sleep: Whether what is at rest is passed over until something touches it; several times faster.
        object_friction: Coulomb coefficient between objects.
        arm_friction: Coulomb coefficient between the arm and all else.
        turning_friction: Of a contact against turning on the spot (m).
        rolling_friction: Of a contact against rolling (m).
        stall_lag: How far the fingertip may fall behind its trajectory before it counts as stalled (m).
    """

    step: Annotated[float, Field(gt=0.0, le=0.005)] = 0.002
    sleep: bool = True
    object_friction: Coefficient = 0.2
    arm_friction: Coefficient = 0.3
    turning_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.005
    rolling_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.0005
    stall_lag: Annotated[float, Field(gt=0.0, le=0.2)] = 0.015


OptionsT = TypeVar("OptionsT", bound=JointOptions)
WorldT = TypeVar("WorldT", bound=JointWorld)
SnapshotT = TypeVar("SnapshotT", bound=HasState)


class JointPhysics(Physics[OptionsT], Generic[OptionsT, WorldT, SnapshotT]):
    """Physics with a world of joints. An engine says how a world is made, caught and put back."""

    executes = JointTrajectory
    _world: WorldT | None = None

    @abstractmethod
    def _new_world(self) -> WorldT:
        """A world, in any state.

        Raises:
            IncompatibleError: If the engine cannot have the arm.
        """

    @abstractmethod
    def _take(self, world: WorldT) -> SnapshotT:
        """The world as it is now, moving or not."""

    @abstractmethod
    def _put_back(self, world: WorldT, snapshot: SnapshotT) -> None:
        """Make the world be what it was when the snapshot was taken."""

    def restore(self, state: State) -> State:
        """Put everything where ``state`` has it, at rest."""
        world = self._world or self._new_world()
        world.restore(state)
        self._world = world
        return world.read_state()

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
        return self._current.read_state()

    def snapshot(self) -> SnapshotT:
        """The world as it is now, moving or not."""
        return self._take(self._current)

    def state_of(self, snapshot: SnapshotT) -> State:
        """What a snapshot holds, its speeds aside."""
        return snapshot.state

    def propagate(
        self,
        snapshot: SnapshotT,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[SnapshotT, Motion]:
        """Hold a fingertip twist for ``dt`` seconds, without settling; see ``SupportsPropagation``.

        Raises:
            ArmError: If the arm is parked, or cannot follow.
        """
        arm = snapshot.state.arm
        if arm is None:
            raise ArmError("a parked arm cannot be propagated: give a state in which it stands somewhere")
        world = self._current
        self._put_back(world, snapshot)
        motion = self.execute(held_twist(world, arm, twist, dt, opening), settle=None, stop=stop)
        return self._take(world), motion

    def close(self) -> None:
        """Drop the world."""
        self._world = None

    @property
    def _current(self) -> WorldT:
        if self._world is None:
            self.restore(self.scene.initial_state())
        assert self._world is not None
        return self._world
