"""The interface of physics engines."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, Protocol, TypeVar, runtime_checkable

from phframe.core.arm import ArmModel
from phframe.core.errors import InputError
from phframe.core.motion import Motion, Transition
from phframe.core.options import Options
from phframe.core.scene import Scene
from phframe.core.shelf import BasePose
from phframe.core.state import State
from phframe.core.trajectory import GripperTrajectory, JointTrajectory, Trajectory
from phframe.core.value import FloatArray

OptionsT = TypeVar("OptionsT", bound=Options)


@dataclass(frozen=True, slots=True)
class Settle:
    """When the world counts as at rest after a motion. What has spilled does not count.

    Attributes:
        speed: Every object's speed stays below this (m/s) ...
        hold: ... for this long (s).
        timeout: Stop waiting after this long (s) and say so in the motion.
    """

    speed: float = 0.005
    hold: float = 0.05
    timeout: float = 3.0

    def __post_init__(self) -> None:
        if not (0.0 < self.speed < math.inf and 0.0 <= self.hold < math.inf and 0.0 < self.timeout < math.inf):
            raise InputError(f"settling needs finite, positive figures, not {self}")


@dataclass(frozen=True, slots=True)
class Stop:
    """When to end a motion early. The arm then stands where it was.

    Attributes:
        force: A force on the arm above this (N), as ``Motion.largest_force`` has it; None: never.
        bodies: The first contact of the arm with any of these objects.
        wall: Any contact of the arm with a wall.
    """

    force: float | None = None
    bodies: frozenset[str] = frozenset()
    wall: bool = False


@dataclass(frozen=True, slots=True)
class Watch:
    """Lets somebody look on while a motion runs. Watching never changes what happens.

    Attributes:
        period: Seconds of simulated time between looks.
        look: Called with the time since the motion began (s) and the world as it is then, moving or not: at the
            beginning, once in every period, settling included, and at the end.
    """

    period: float
    look: Callable[[float, State], None]

    def __post_init__(self) -> None:
        if not 0.0 < self.period < math.inf:
            raise InputError(f"the period of a watch must be a finite number above 0, not {self.period!r}")


class Physics(ABC, Generic[OptionsT]):
    """One scene with one arm in one physics engine.

    Two ways to use it, never mixed: ``simulate`` is pure and for planning; ``restore`` once and then ``execute`` again
    and again, each going on from where the world is, is for carrying a plan out.

    Contract: ``simulate(s, t)`` depends on ``s`` and ``t`` alone: the same bits every time, whatever ran before. (A
    restored run need not equal the uninterrupted one: engines lose what they remember of their contacts.)
    """

    options_type: ClassVar[type[Options]] = Options
    executes: ClassVar[type[GripperTrajectory] | type[JointTrajectory]] = GripperTrajectory
    """A planar engine drives the gripper, an articulated one the joints."""

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: OptionsT) -> None:
        self.scene, self.arm, self.base_pose, self.options = scene, arm, base_pose, options

    @abstractmethod
    def restore(self, state: State) -> State:
        """Make the world be ``state``, at rest, rebuilding it if need be; return what it really holds now.

        What ``state`` says is held is held.

        Raises:
            InputError: If ``state`` is not one of this scene and this arm.
        """

    @abstractmethod
    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        """Drive the arm along a trajectory from where the world is.

        Args:
            trajectory: Of the kind named by ``executes``; it begins where the arm is. A planar engine places a parked arm
                at its beginning; an articulated one has it at home.
            settle: Wait for rest afterwards; None: do not.
            stop: When to end early, besides a stall at the trajectory's force limit.
            watch: Look on.

        At a stall or a stop the arm stands still where it is, with no preload.

        Raises:
            InputError: If the trajectory begins more than 2 mm or 0.01 rad from where the arm is.
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """

    @abstractmethod
    def observe(self) -> State:
        """The world as it is now."""

    @abstractmethod
    def close(self) -> None:
        """Give the engine's memory back. May be called twice."""

    def simulate(
        self,
        state: State,
        trajectory: Trajectory,
        *,
        settle: Settle | None = Settle(),
        stop: Stop | None = None,
        watch: Watch | None = None,
    ) -> Transition:
        """What a trajectory would make of a state: a pure function of its arguments. For those, see ``execute``."""
        self.restore(state)
        motion = self.execute(trajectory, settle=settle, stop=stop, watch=watch)
        return Transition(self.observe(), motion)


@runtime_checkable
class SupportsManySimulations(Protocol):
    """What a backend may offer besides, that simulates many motions in one call and in less time."""

    def simulate_many(
        self,
        states: Sequence[State],
        trajectories: Sequence[Trajectory],
        *,
        settle: Settle | None = Settle(),
        stop: Stop | None = None,
    ) -> list[Transition]:
        """``simulate`` of each state and its trajectory, in their order: the same bits as one by one.

        Args:
            states: One for each trajectory.
            trajectories: Of the kind named by ``executes``; each begins where the arm of its state is.
            settle: As in ``simulate``.
            stop: Likewise.

        Raises:
            InputError: As ``restore`` and ``execute``, before any is simulated.
            SimulationDivergedError: If one diverged.
        """


SnapshotT = TypeVar("SnapshotT")


@runtime_checkable
class SupportsPropagation(Protocol[SnapshotT]):
    """What a backend may offer besides, for planners that steer at control level (kinodynamic ones).

    A snapshot is opaque, immutable and belongs to the backend that made it; unlike a State it holds speeds.
    """

    def snapshot(self) -> SnapshotT:
        """The world as it is now, moving or not."""

    def state_of(self, snapshot: SnapshotT) -> State:
        """What a snapshot holds, its speeds aside."""

    def propagate(
        self,
        snapshot: SnapshotT,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[SnapshotT, Motion]:
        """Hold a fingertip twist ``(3,)`` (m/s, m/s, rad/s, shelf frame) for ``dt`` seconds, without settling; pure.

        What ``execute`` and ``observe`` would go on from afterwards is undefined: ``restore`` first.

        Args:
            snapshot: Where to start.
            twist: Of the fingertip.
            dt: Seconds.
            opening: Distance between the fingers (m); None: as it is.
            stop: When to end early.

        Raises:
            ArmError: If the arm is parked.
        """
