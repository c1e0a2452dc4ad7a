"""Physics in the plane, seen from above, with pymunk: the fast default.

Objects slide on the board with Coulomb friction and do not topple. The arm is a body that a drive of limited force
draws along its trajectory, so that what cannot be moved stalls it and nothing is squeezed through a wall. An object
whose centre leaves the board at the mouth is spilled.
"""

from __future__ import annotations

from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import Field

from phframe.backends.pymunk_.drive import PymunkDrive
from phframe.backends.pymunk_.gripper import hold, place_arm, set_opening
from phframe.backends.pymunk_.measures import take_measures
from phframe.backends.pymunk_.state import PymunkSnapshot, read_state, set_in_motion, take_snapshot
from phframe.backends.pymunk_.world import PymunkModel, PymunkSurfaces, ShelfSpace, build_world, meeting, trimmed
from phframe.core import (
    ArmError,
    FloatArray,
    GripperTrajectory,
    Motion,
    Options,
    Phase,
    Physics,
    Settle,
    State,
    Stop,
    Trajectory,
    Watch,
    refuse_foreign,
)


class PymunkOptions(Options):
    """Options of the pymunk backend.

    Attributes:
        step: Time step (s).
        iterations: Solver iterations per step.
        object_friction: Coulomb coefficient between objects.
        arm_friction: Coulomb coefficient between the arm and objects.
        arm_mass: Inertia of the arm as the world feels it (kg).
        arm_acceleration: With which the arm comes to rest at the corners of its path (m/s^2); None: it stops dead.
        standing_radius: Fraction of its radius at which an object stands on the board; friction acts there, so that what
            slides is easily turned. 2/3 resists turning on the spot as a disc does that presses evenly. None: turning
            is resisted as if nothing slid.
        stall_lag: How far the arm may fall behind its trajectory before it counts as stalled (m).
    """

    step: Annotated[float, Field(ge=1e-4, le=0.02)] = 1.0 / 240.0
    iterations: Annotated[int, Field(ge=1, le=200)] = 10
    object_friction: Annotated[float, Field(gt=0.0, le=2.0)] = 0.2
    arm_friction: Annotated[float, Field(ge=0.0, le=2.0)] = 0.3
    arm_mass: Annotated[float, Field(gt=0.0, le=100.0)] = 4.0
    arm_acceleration: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    standing_radius: Annotated[float, Field(gt=0.0, le=1.0)] | None = None
    stall_lag: Annotated[float, Field(gt=0.0, le=0.1)] = 0.005


class PymunkPhysics(Physics[PymunkOptions]):
    """pymunk 7 behind the Physics interface.

    Every ``restore`` builds a new space (under a millisecond): only that keeps ``simulate`` pure, since pymunk's
    contact cache and broad phase remember what ran before.
    """

    options_type = PymunkOptions
    executes = GripperTrajectory
    _world: ShelfSpace | None = None

    def restore(self, state: State) -> State:
        """Build a new space that holds ``state``."""
        refuse_foreign(self.scene, self.arm.shape, state)
        self._world = world = build_world(self.model, state)
        if state.arm is not None:
            place_arm(world, state.arm.gripper.tolist())
            set_opening(world, state.arm.opening)
            world.command = state.arm.commanded_opening
        if state.held is not None and state.held in world.items:
            hold(world, world.items[state.held], world.command)
        return read_state(world)

    @cached_property
    def model(self) -> PymunkModel:
        """What all worlds that this object builds have in common."""
        o, shape = self.options, self.arm.shape
        surfaces = PymunkSurfaces(o.object_friction, o.arm_friction, o.standing_radius)
        outlines = tuple(trimmed(outline.vertices) for outline in shape.closed)
        heights = {item.shape.height for item in self.scene.objects}
        met = {height: meeting(shape, height) for height in heights}
        return PymunkModel(self.scene, shape, outlines, take_measures(shape), surfaces, o.iterations, o.arm_mass, met)

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        """Drive the gripper along a trajectory."""
        if not isinstance(trajectory, GripperTrajectory):
            # A joint trajectory has its times from what the arm can do: it brakes by itself.
            return self._drive(trajectory.gripper, None, stop, watch).run(settle)
        return self._drive(trajectory, self.options.arm_acceleration, stop, watch).run(settle)

    def _drive(
        self, trajectory: GripperTrajectory, braking: float | None, stop: Stop | None, watch: Watch | None
    ) -> PymunkDrive:
        o = self.options
        return PymunkDrive(
            self._current, trajectory, step=o.step, stall_lag=o.stall_lag, acceleration=braking, stop=stop, watch=watch
        )

    def observe(self) -> State:
        """The world as it is now."""
        return read_state(self._current)

    def snapshot(self) -> PymunkSnapshot:
        """The world as it is now, moving or not."""
        return take_snapshot(self._current)

    def state_of(self, snapshot: PymunkSnapshot) -> State:
        """What a snapshot holds, its speeds aside."""
        return snapshot.state

    def propagate(
        self,
        snapshot: PymunkSnapshot,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[PymunkSnapshot, Motion]:
        """Hold a fingertip twist for ``dt`` seconds, without settling; see ``SupportsPropagation``."""
        arm = snapshot.state.arm
        if arm is None:
            raise ArmError("a parked arm cannot be propagated: give a state in which it stands somewhere")
        self.restore(snapshot.state)
        set_in_motion(self._current, snapshot.velocities)
        times, poses = np.array([0.0, dt]), np.array([arm.gripper, arm.gripper + twist * dt])
        openings = np.array([arm.commanded_opening, arm.commanded_opening if opening is None else opening])
        held = GripperTrajectory(times, poses, openings, (Phase.SWEEP,), self.arm.force_limit)
        # A twist is held to its end: the arm does not brake between one control and the next.
        motion = self._drive(held, None, stop, None).run(None)
        return take_snapshot(self._current), motion

    def close(self) -> None:
        """Drop the space."""
        self._world = None

    @property
    def _current(self) -> ShelfSpace:
        if self._world is None:
            self.restore(self.scene.initial_state())
        assert self._world is not None
        return self._world
