"""The world that planners plan in: it applies actions to any state, and never goes on from where it is."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import repeat
from multiprocessing import get_context
from typing import Any

import numpy as np

from phframe.core import (
    NOBODY,
    Action,
    Advisor,
    ArmShape,
    ArmState,
    Budget,
    FloatArray,
    Goal,
    Motion,
    OptionError,
    Rejection,
    State,
    Stop,
    StopCause,
    StopReason,
    SupportsPropagation,
    Task,
    TopologyEngine,
    Transition,
    Unreachable,
    Watch,
)
from phframe.core.task import ObjectReach, Pair, Reach
from phframe.runtime.world import World, WorldSpec


class PlanningWorld(World):
    """Applies actions: pure, from any state.

    Args:
        spec: What to build.
        workers: Processes over which ``apply_many`` spreads its work; 1: none but this one.
    """

    def __init__(self, spec: WorldSpec, workers: int = 1) -> None:
        super().__init__(spec)
        if not workers >= 1 or workers != int(workers):
            raise OptionError(f"workers must be a whole number of 1 or more, not {workers!r}")
        self._workers = workers
        self._pool: ProcessPoolExecutor | None = None

    def apply(self, state: State, action: Action, stop: Stop | None = None, watch: Watch | None = None) -> Transition:
        """What an action makes of a state: a function of the two alone. One that the arm cannot do changes nothing."""
        held = self.physics.restore(state)
        trajectory = self.plan_trajectory(held, action)
        if isinstance(trajectory, Unreachable):
            return Transition(state, Motion(0.0, stopped=StopReason(StopCause.UNREACHABLE, unreachable=trajectory)))
        motion = self.follow(trajectory, watch, stop)
        return Transition(self.physics.observe(), motion)

    def apply_many(self, pairs: Sequence[Pair], stop: Stop | None = None) -> list[Transition]:
        """``apply`` to many pairs, in their order; the same bits whatever the number of workers."""
        if self._workers == 1 or len(pairs) < 2:
            return [self.apply(state, action, stop) for state, action in pairs]
        if self._pool is None:
            context = get_context("spawn")
            self._pool = ProcessPoolExecutor(self._workers, context, _Worker.begin, (self.spec,))
        results = list(self._pool.map(_Worker.apply, pairs, repeat(stop), chunksize=1))
        self.motion_planning_time += sum(seconds for _, seconds in results)
        return [transition for transition, _ in results]

    def task(
        self,
        start: State,
        topology: TopologyEngine[Any],
        rng: np.random.Generator,
        *,
        goal: Goal[Any],
        arm: ArmShape | None = None,
        budget: Budget = Budget(),  # noqa: B008 - immutable
        rejected: tuple[Rejection, ...] = (),
        reach: Reach | None = None,
        object_reach: ObjectReach | None = None,
        advisor: Advisor = NOBODY,
    ) -> Task:
        """The problem of achieving a goal from a state in this world.

        Args:
            start: The state.
            topology: For the planner.
            rng: For the planner.
            goal: What is to be achieved.
            arm: The one that will carry the plan out; None: this world's.
            budget: What the planner may spend.
            rejected: Actions that could not be carried out, or came to nothing.
            reach: Whether the arm that will carry the plan out can follow an action; None: not known.
            object_reach: Whether that arm can have an object grasped where it stands; None: not known.
            advisor: Whom the planner may ask.
        """
        return Task(
            scene=self.scene,
            start=start,
            goal=goal,
            arm=self.arm.shape if arm is None else arm,
            topology=topology,
            apply=self.apply,
            apply_many=self.apply_many if self._workers > 1 else None,
            rng=rng,
            budget=budget,
            rejected=rejected,
            reach=reach,
            object_reach=object_reach,
            steered=self.physics if isinstance(self.physics, SupportsPropagation) else None,
            begin_steering=self._begin_steering,
            advisor=advisor,
        )

    def _begin_steering(self, state: State, pose: FloatArray | None) -> Any:
        """The snapshot of a state in which the arm stands somewhere: a parked one at a pose, or where it is parked."""
        if state.arm is None:
            joints = self.arm.home if pose is None and self.by_joints else None
            arm = ArmState(self.home if pose is None else pose, self.arm.shape.min_opening, joints=joints)
            state = replace(state, arm=arm)
        self.physics.restore(state)
        assert isinstance(self.physics, SupportsPropagation), "asked for only then"
        return self.physics.snapshot()

    def close(self) -> None:
        """Give the engine's memory back and end the workers."""
        super().close()
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None


class _Worker:
    """The one world of a worker process."""

    world: PlanningWorld

    @classmethod
    def begin(cls, spec: WorldSpec) -> None:
        cls.world = PlanningWorld(spec)

    @classmethod
    def apply(cls, pair: Pair, stop: Stop | None) -> tuple[Transition, float]:
        """The transition, and how long motion planning took for it (s)."""
        before = cls.world.motion_planning_time
        return cls.world.apply(*pair, stop), cls.world.motion_planning_time - before
