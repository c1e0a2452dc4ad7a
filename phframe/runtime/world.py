"""What every world is: one scene, one arm and one engine, and how an action is carried out in it."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import TracebackType
from typing import Any, Self

import numpy as np

from phframe.core import (
    MOUTH_CLEARANCE,
    Action,
    Contacts,
    GripperPath,
    GripperTrajectory,
    IncompatibleError,
    JointTrajectory,
    Motion,
    MotionPlanner,
    Phase,
    PhaseRule,
    Physics,
    Scene,
    Settle,
    State,
    Stop,
    StopCause,
    Trajectory,
    Unreachable,
    Watch,
    motion_planner_of,
    starting_from,
    time_path,
)
from phframe.core.arm import LEAST_SERVED
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.registry import Kind, load
from phframe.runtime.border import check_arm, copied_scene
from phframe.runtime.guarded_physics import guarded
from phframe.runtime.mounting import arm_in

APPROACH_SPEED = 0.5
"""Of the fingertip outside the shelf, in free space (m/s)."""
RETREAT_SPEED = 0.25
"""Of the fingertip that draws back after a stall (m/s)."""
LONGEST_ACTION = 1000.0
"""Of the world's time (s): ten times what the slowest push takes. A simulation that was begun is not interrupted."""
MOTION_ATTEMPTS, MOTION_SECONDS = 10, 300.0
"""How often a motion planner may try anew, and for how long (s)."""


@dataclass(frozen=True, slots=True)
class WorldSpec:
    """All it takes to build a world, by name: small and picklable, so that workers build their own.

    Attributes:
        scene: The scene.
        backend: Physics backend: a registered name, a class in a file, or a class.
        arm: Arm: likewise, or an object.
        backend_options: Of the backend, by key; values or their text.
        arm_options: Of the arm, by key.
    """

    scene: Scene
    backend: Any = "pymunk"
    arm: Any = "planar"
    backend_options: Mapping[str, Any] = field(default_factory=dict)
    arm_options: Mapping[str, Any] = field(default_factory=dict)


class World:
    """A physics engine with a scene and an arm in it. Close it, or use it in a ``with``.

    Two kinds of it are used: a ``PlanningWorld`` applies actions, an ``ExecutionWorld`` executes them.

    Args:
        spec: What to build.

    Attributes:
        motion_planning_time: Wall time spent on motion planning so far (s), in workers too.

    Raises:
        UnknownNameError: If the backend or the arm does not exist.
        NotInstalledError: If its library is not installed.
        OptionError: If an option is unknown or out of range.
        IncompatibleError: If arm and backend cannot go together.
    """

    def __init__(self, spec: WorldSpec) -> None:
        self.spec, self.scene = spec, spec.scene
        self.arm, self.base_pose = arm_in(spec.scene, spec.arm, spec.arm_options)
        backend: type[Physics[Any]] = load(Kind.BACKEND, spec.backend)
        options = backend.options_type.parse(spec.backend_options, f"backend {spec.backend}")
        self._motion_planner = None
        if backend.executes is JointTrajectory:
            self._motion_planner = motion_planner_of(self.arm, spec.scene, self.base_pose)
        self.motion_planning_time = 0.0
        check_arm(self.arm, spec.arm)
        made = backend(copied_scene(backend, spec.scene), self.arm, self.base_pose, options)
        self.physics: Physics[Any] = guarded(made, spec.scene, spec.backend)
        self.home = self.arm.gripper_pose(self.arm.home, self.base_pose)
        self._refuse_misfit()

    def _refuse_misfit(self) -> None:
        """Refuse an arm that stands in the shelf, or does not reach through it."""
        shelf, arm = self.scene.shelf, self.spec.arm
        if self.home[0] + self.arm.shape.front(float(self.home[2])) >= 0.0:
            raise IncompatibleError(
                f"arm {arm!r} at its base pose {self.base_pose} stands in the shelf when it is parked"
            )
        length = -min(float(outline.vertices[:, 0].min()) for outline in self.arm.shape.closed)
        if length < shelf.depth:
            raise IncompatibleError(f"arm {arm!r} is {length:g} m long, too short for a shelf {shelf.depth:g} m deep")
        if self._motion_planner is not None:
            self._refuse_base_pose()

    def _refuse_base_pose(self) -> None:
        """Refuse a base pose from which the arm's joints reach too little of the shelf."""
        fraction = self.arm.fraction_served(self.scene.shelf, self.base_pose, LEAST_SERVED)
        if fraction is not None and fraction < LEAST_SERVED:
            raise IncompatibleError(
                f"arm {self.spec.arm!r} at its base pose {self.base_pose} reaches {fraction:.0%} of the shelf, and "
                f"{LEAST_SERVED:.0%} is the least to begin with: give the scene another base pose; "
                "'phframe arm reach' draws what one reaches"
            )

    @property
    def by_joints(self) -> bool:
        """Whether the engine drives the arm's joints, which a motion planner finds, not its outline."""
        return self._motion_planner is not None

    def plan_trajectory(self, state: State, action: Action) -> Trajectory | Unreachable:
        """Plan what to drive to carry out an action from a state: the approach to the path's beginning, and the path."""
        if (refusal := self._refuse_opening(action)) is not None:
            return refusal
        if self._motion_planner is not None:
            timed = time_path(action.path, action.path.rule(0).opening, self.arm.force_limit)
            return _refuse_long(timed) or self._plan_joint_trajectory(self._motion_planner, state, action.path)
        pose = self.home if state.arm is None else state.arm.gripper
        first = action.path.rule(0).opening
        path = starting_from(action.path, pose, PhaseRule(APPROACH_SPEED, first, Contacts.NONE))
        opening = self.arm.shape.min_opening if state.arm is None else state.arm.commanded_opening
        timed = time_path(path, opening, self.arm.force_limit)
        return _refuse_long(timed) or timed

    def _plan_joint_trajectory(
        self, planner: MotionPlanner[Any], state: State, path: GripperPath
    ) -> JointTrajectory | Unreachable:
        """The same joints for the same state and path, every time."""
        began = time.perf_counter()
        try:
            rng = np.random.default_rng(0)
            return planner.plan(path, state, attempts=MOTION_ATTEMPTS, seconds=MOTION_SECONDS, rng=rng)
        finally:
            self.motion_planning_time += time.perf_counter() - began

    def _refuse_opening(self, action: Action) -> Unreachable | None:
        """Why the gripper cannot do an action, if it cannot."""
        shape = self.arm.shape
        for leg, phase in enumerate(action.path.phases):
            rule = action.path.rule(leg)
            if not shape.min_opening - 1e-9 <= rule.opening <= shape.max_opening + 1e-9:
                span = f"from {shape.min_opening:g} to {shape.max_opening:g} m"
                return Unreachable(0.0, f"the gripper opens {span}, not to {rule.opening:g} m to {phase}")
        return None

    def follow(self, trajectory: Trajectory, watch: Watch | None = None, stop: Stop | None = None) -> Motion:
        """Follow a trajectory from where the world is and let things settle.

        After a stall, or at the first touch of a wall, draw straight back; where another stop was asked for, stand there.
        """
        ending = Stop(wall=True) if stop is None else replace(stop, wall=True)
        motion = self.physics.execute(trajectory, settle=Settle(), stop=ending, watch=watch)
        asked_for = motion.stopped is not None and motion.stopped.cause is not StopCause.WALL
        if motion.complete or asked_for:
            return motion
        retreat = self._retreat(self.physics.observe())
        if isinstance(retreat, Unreachable):
            return motion
        later = (
            None
            if watch is None
            else Watch(watch.period, lambda after, seen: watch.look(motion.duration + after, seen))
        )
        return motion.then(self.physics.execute(retreat, settle=Settle(), watch=later))

    def _retreat(self, state: State) -> Trajectory | Unreachable:
        """Straight back along the gripper's axis until the whole arm is before the mouth."""
        assert state.arm is not None, "an arm that has stalled is not parked"
        pose, opening = state.arm.gripper, state.arm.commanded_opening
        ahead = np.array([np.cos(pose[2]), np.sin(pose[2])])
        away = max(0.0, float(pose[0]) + MOUTH_CLEARANCE + self.arm.shape.front(float(pose[2]))) / max(
            ahead[0], LEAST_AHEAD
        )
        out = np.array([*(pose[:2] - away * ahead), pose[2]])
        rule = PhaseRule(RETREAT_SPEED, opening, Contacts.OBJECTS)
        path = GripperPath(np.array([pose, out]), (Phase.RETREAT,), {Phase.RETREAT: rule})
        if self._motion_planner is not None:
            return self._plan_joint_trajectory(self._motion_planner, state, path)
        return time_path(path, opening, self.arm.force_limit)

    def close(self) -> None:
        """Give the engine's memory back."""
        self.physics.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _refuse_long(timed: GripperTrajectory) -> Unreachable | None:
    """Why a path is not followed at its speeds: for the time that it takes."""
    if timed.duration <= LONGEST_ACTION:
        return None
    return Unreachable(0.0, f"it takes {timed.duration:.0f} s; an action may take {LONGEST_ACTION:.0f} s")
