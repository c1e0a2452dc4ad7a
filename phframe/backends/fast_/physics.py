"""Physics in the plane, seen from above, compiled: what plans are made in.

The model is that of the pymunk backend: discs that slide on the board, an arm on a drive of limited force. The method is
another: a few large implicit steps instead of many small ones (Stewart and Trinkle, An implicit time-stepping scheme for rigid
body dynamics with inelastic collisions and Coulomb friction, IJNME 39, 1996), with one limit surface for the board, and none at
all while nothing moves and the arm is near nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from phframe.backends.contract import START_ANGLE, START_POSITION
from phframe.backends.fast_ import layout
from phframe.backends.fast_.engine import compile_all, go_on, reset
from phframe.backends.fast_.layout import FastPath, FastRun, FastWorld
from phframe.backends.fast_.many import run_many
from phframe.backends.fast_.model import FastFigures, build_world, make_run
from phframe.backends.fast_.state import FastSnapshot, StateReader, legs_of
from phframe.backends.fast_.watching import go_on_watched
from phframe.core import (
    ArmError,
    ArmModel,
    BasePose,
    FloatArray,
    GripperTrajectory,
    InputError,
    JointTrajectory,
    Motion,
    Options,
    Phase,
    Physics,
    Scene,
    Settle,
    State,
    Stop,
    Trajectory,
    Transition,
    Watch,
    refuse_foreign,
)


class FastOptions(Options):
    """Options of the fast backend.

    Attributes:
        step: How far the fingertip moves in a step (m).
        iterations: Solver iterations per step, at most.
        object_friction: Coulomb coefficient between objects.
        arm_friction: Coulomb coefficient between the arm and objects.
        arm_mass: Inertia of the arm as the world feels it (kg).
        arm_acceleration: With which the arm comes to rest at the corners of its path (m/s^2); None: it stops dead.
        standing_radius: Lever at which the board resists an object's turning, as a fraction of its radius; 2/3 for even
            pressure.
        stall_lag: How far the arm may fall behind its trajectory before it counts as stalled (m).
    """

    step: Annotated[float, Field(ge=5e-4, le=0.01)] = 0.004
    iterations: Annotated[int, Field(ge=1, le=500)] = 30
    object_friction: Annotated[float, Field(ge=0.0, le=2.0)] = 0.2
    arm_friction: Annotated[float, Field(ge=0.0, le=2.0)] = 0.3
    arm_mass: Annotated[float, Field(gt=0.0, le=100.0)] = 4.0
    arm_acceleration: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    standing_radius: Annotated[float, Field(gt=0.0, le=1.0)] = 2.0 / 3.0
    stall_lag: Annotated[float, Field(gt=0.0, le=0.1)] = 0.005


class FastPhysics(Physics[FastOptions]):
    """The compiled engine behind the Physics interface."""

    options_type = FastOptions
    executes = GripperTrajectory
    _restored: State | None = None

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: FastOptions) -> None:
        super().__init__(scene, arm, base_pose, options)
        compile_all(self.world, self._run)

    @cached_property
    def world(self) -> FastWorld:
        """The world as it is now, in arrays."""
        o = self.options
        figures = FastFigures(
            step=o.step,
            iterations=o.iterations,
            object_friction=o.object_friction,
            arm_friction=o.arm_friction,
            arm_mass=o.arm_mass,
            standing_radius=o.standing_radius,
            stall_lag=o.stall_lag,
        )
        return build_world(self.scene, self.arm.shape, figures)

    @cached_property
    def reader(self) -> StateReader:
        """Turns states into arrays and back."""
        return StateReader(self.scene, self.arm.shape)

    @cached_property
    def _run(self) -> FastRun:
        return make_run(self.world, len(Phase))

    def restore(self, state: State) -> State:
        """Write ``state`` into the world, which then remembers nothing else."""
        refuse_foreign(self.scene, self.arm.shape, state)
        reader = self.reader
        reset(self.world, reader.bodies(state), reader.arm(state))
        self._restored = state
        return self.observe()

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        """Drive the gripper along a trajectory."""
        gripper, braking = self._gripper(trajectory)
        return self._follow(gripper, braking, settle, stop, watch)

    def _gripper(self, trajectory: Trajectory) -> tuple[GripperTrajectory, float | None]:
        """What the fingertip does, and how it brakes; a joint trajectory has its times from what the arm can do."""
        if isinstance(trajectory, JointTrajectory):
            return trajectory.gripper, None
        return trajectory, self.options.arm_acceleration

    def _follow(
        self,
        trajectory: GripperTrajectory,
        braking: float | None,
        settle: Settle | None,
        stop: Stop | None,
        watch: Watch | None,
    ) -> Motion:
        world, run = self._current, self._run
        _refuse_jump(world.arm, trajectory.poses[0])
        limits = self.reader.limits(trajectory.force_limit, stop, braking, settle)
        path = FastPath(legs_of(trajectory), limits)
        if watch is None:
            go_on(world, path, run, True, math.inf)
        else:
            self._go_on_watched(path, watch)
        return self.reader.motion(run.figures, run.events, trajectory)

    def _go_on_watched(self, path: FastPath, watch: Watch) -> None:
        assert self._restored is not None
        go_on_watched(self.world, path, self._run, watch, self.reader, self._restored)

    def observe(self) -> State:
        """The world as it is now."""
        world = self._current
        assert self._restored is not None
        return self.reader.state(world.bodies, world.arm, self._restored)

    def simulate_many(
        self,
        states: Sequence[State],
        trajectories: Sequence[Trajectory],
        *,
        settle: Settle | None = Settle(),  # noqa: B008 - immutable
        stop: Stop | None = None,
    ) -> list[Transition]:
        """``simulate`` of each state and trajectory, the same bits; see ``SupportsManySimulations``."""
        for state, trajectory in zip(states, trajectories, strict=True):
            refuse_foreign(self.scene, self.arm.shape, state)
            if state.arm is not None:
                _refuse_jump(self.reader.arm(state), self._gripper(trajectory)[0].poses[0])
        self._restored = None
        paths = [self._gripper(trajectory) for trajectory in trajectories]
        return run_many(self.world, self._run, self.reader, states, paths, settle, stop)

    def snapshot(self) -> FastSnapshot:
        """The world as it is now, moving or not."""
        state = self.observe()
        return FastSnapshot(state, self.world.bodies[: len(self.scene.objects), layout.SPEEDS])

    def state_of(self, snapshot: FastSnapshot) -> State:
        """What a snapshot holds, its speeds aside."""
        return snapshot.state

    def propagate(
        self,
        snapshot: FastSnapshot,
        twist: FloatArray,
        dt: float,
        *,
        opening: float | None = None,
        stop: Stop | None = None,
    ) -> tuple[FastSnapshot, Motion]:
        """Hold a fingertip twist for ``dt`` seconds, without settling; see ``SupportsPropagation``."""
        arm = snapshot.state.arm
        if arm is None:
            raise ArmError("a parked arm cannot be propagated: give a state in which it stands somewhere")
        self.restore(snapshot.state)
        self.world.bodies[: len(snapshot.velocities), layout.SPEEDS] = snapshot.velocities
        self.world.arm[layout.RESTING] = float(not snapshot.velocities.any())
        poses = np.array([arm.gripper, arm.gripper + twist * dt])
        openings = np.array([arm.commanded_opening, arm.commanded_opening if opening is None else opening])
        held = GripperTrajectory(np.array([0.0, dt]), poses, openings, (Phase.SWEEP,), self.arm.force_limit)
        # A twist is held to its end: the arm does not brake between one control and the next.
        motion = self._follow(held, None, None, stop, None)
        return self.snapshot(), motion

    def close(self) -> None:
        """Forget the world."""
        self._restored = None

    @property
    def _current(self) -> FastWorld:
        if self._restored is None:
            self.restore(self.scene.initial_state())
        return self.world


def _refuse_jump(arm: FloatArray, pose: FloatArray) -> None:
    if arm[layout.PARKED] == 1.0:
        return
    distance = math.hypot(pose[0] - arm[layout.BODY_X], pose[1] - arm[layout.BODY_Y])
    turn = abs(float(pose[2] - arm[layout.YAW]))
    if distance > START_POSITION or turn > START_ANGLE:
        raise InputError(f"the trajectory begins {distance:.3f} m and {turn:.3f} rad from where the arm is")
