"""A test stand: a backend with a scene, driven along paths of the gripper whatever it executes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from phframe.core import (
    BasePose,
    FloatArray,
    GripperPath,
    GripperTrajectory,
    InputError,
    JointTrajectory,
    Phase,
    Physics,
    Scene,
    Settle,
    State,
    Stop,
    Trajectory,
    Transition,
    Watch,
    starting_from,
    time_path,
)
from phframe.testing.check import NotApplicableError
from phframe.testing.physics.paths import rule
from phframe.testing.physics.straight_joints import plan_straight
from phframe.testing.subjects import PhysicsUnderTest


class PhysicsStand:
    """One backend with one scene, and the gripper at hand.

    Args:
        subject: What is tested.
        scene: The scene.
    """

    def __init__(self, subject: PhysicsUnderTest, scene: Scene) -> None:
        self.subject, self.scene, self.arm = subject, scene, subject.arm
        self.tolerances = subject.tolerances
        self.base_pose: BasePose = subject.arm.default_base_pose(scene.shelf)
        self.physics: Physics[Any] = subject.factory(scene, subject.arm, self.base_pose)
        self.start = scene.initial_state()

    def trajectory(self, state: State, path: GripperPath, force_limit: float | None = None) -> Trajectory:
        """A path with its times, from where the gripper is in a state.

        Raises:
            NotApplicableError: If the backend executes joints and the arm cannot follow the path.
        """
        path, opening = self._closed_as_it_closes(path), self.arm.shape.min_opening
        if state.arm is None:
            opening = path.rule(0).opening
        else:
            path = starting_from(
                path, state.arm.gripper, path.rules.get(Phase.APPROACH, rule(opening=state.arm.commanded_opening))
            )
            opening = state.arm.commanded_opening
        timed = time_path(path, opening, self.arm.force_limit if force_limit is None else force_limit)
        return self.driven(state, timed)

    def _closed_as_it_closes(self, path: GripperPath) -> GripperPath:
        """A path for fingers that close all the way, for a gripper whose do not."""
        least = self.arm.shape.min_opening
        rules = {phase: replace(found, opening=max(found.opening, least)) for phase, found in path.rules.items()}
        return replace(path, rules=rules)

    def driven(self, state: State, trajectory: GripperTrajectory) -> Trajectory:
        """What the backend executes for a gripper trajectory that begins in a state.

        Raises:
            NotApplicableError: If the backend executes joints and the arm cannot follow it.
        """
        if self.physics.executes is not JointTrajectory:
            return trajectory
        plan = self.subject.plan_trajectory or plan_straight
        try:
            return plan(trajectory, state, self.arm, self.base_pose)
        except InputError as error:
            raise NotApplicableError(f"the arm cannot do what this check needs: {error}") from error

    def run(
        self,
        state: State,
        path: GripperPath,
        *,
        force_limit: float | None = None,
        settle: Settle | None = Settle(),  # noqa: B008 - immutable
        stop: Stop | None = None,
        watch: Watch | None = None,
    ) -> Transition:
        """Simulate a path from a state."""
        trajectory = self.trajectory(state, path, force_limit)
        return self.physics.simulate(state, trajectory, settle=settle, stop=stop, watch=watch)

    def standing_still(self, state: State, seconds: float) -> Trajectory:
        """A trajectory in which the gripper of a state that has one stays where it is."""
        assert state.arm is not None
        poses, opening = np.array([state.arm.gripper] * 2), state.arm.commanded_opening
        still = GripperTrajectory(
            np.array([0.0, seconds]), poses, np.full(2, opening), (Phase.INSERT,), self.arm.force_limit
        )
        return self.driven(state, still)

    def center(self, state: State, name: str) -> FloatArray:
        """Centre ``(2,)`` of an object (m)."""
        return np.asarray(state.positions[self.scene.index(name)])


@contextmanager
def on_stand(subject: PhysicsUnderTest, scene: Scene) -> Iterator[PhysicsStand]:
    """A stand whose backend is closed in the end."""
    stand = PhysicsStand(subject, scene)
    try:
        yield stand
    finally:
        stand.physics.close()


class WatchLog:
    """Somebody who looks on, and writes down everything.

    Args:
        period: Seconds between looks.
    """

    def __init__(self, period: float = 1.0 / 60.0) -> None:
        self.times: list[float] = []
        self.states: list[State] = []
        self.watch = Watch(period, self._look)

    def _look(self, time: float, state: State) -> None:
        self.times.append(time)
        self.states.append(state)
