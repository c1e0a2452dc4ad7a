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
    ExploredTree,
    FloatArray,
    Goal,
    Motion,
    OptionError,
    Rejection,
    State,
    Stop,
    StopCause,
    StopReason,
    SupportsManySimulations,
    SupportsPropagation,
    Task,
    TopologyEngine,
    Transition,
    Unreachable,
    Watch,
)
from phframe.core.particle import Apply
from phframe.core.task import ObjectReach, Pair, Reach, Sample
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
        if isinstance(self.physics, SupportsManySimulations):
            return self._apply_at_once(self.physics, pairs, stop)
        if self._workers == 1 or len(pairs) < 2:
            return [self.apply(state, action, stop) for state, action in pairs]
        if self._pool is None:
            context = get_context("spawn")
            self._pool = ProcessPoolExecutor(self._workers, context, _Worker.begin, (self.spec,))
        results = list(self._pool.map(_Worker.apply, pairs, repeat(stop), chunksize=1))
        self.motion_planning_time += sum(seconds for _, seconds in results)
        return [transition for transition, _ in results]

    def _apply_at_once(
        self, physics: SupportsManySimulations, pairs: Sequence[Pair], stop: Stop | None
    ) -> list[Transition]:
        """``apply`` to many pairs in one call of the engine; what has to draw back is done again on its own."""
        planned = [self.plan_trajectory(state, action) for state, action in pairs]
        feasible = [row for row, found in enumerate(planned) if not isinstance(found, Unreachable)]
        ending = Stop(wall=True) if stop is None else replace(stop, wall=True)
        simulated = physics.simulate_many(
            [pairs[row][0] for row in feasible],
            [found for found in planned if not isinstance(found, Unreachable)],
            stop=ending,
        )
        whole = {row: found for row, found in zip(feasible, simulated, strict=True) if _ends_there(found.motion)}
        return [whole[row] if row in whole else self.apply(*pair, stop) for row, pair in enumerate(pairs)]

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
        earlier: ExploredTree | None = None,
        reach: Reach | None = None,
        confirm: Apply | None = None,
        sample: Sample | None = None,
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
            earlier: What the plan before had tried from where it was to be now; None: there was none.
            reach: Whether the arm that will carry the plan out can follow an action; None: not known.
            confirm: Simulates an action in the engine that will carry the plan out; None: that is this world's.
            sample: Draws samples of what the world may be; None: what is believed of it is certain.
            object_reach: Whether that arm can have an object grasped where it stands; None: not known.
            advisor: Whom the planner may ask.
        """
        at_once = isinstance(self.physics, SupportsManySimulations)
        return Task(
            scene=self.scene,
            start=start,
            goal=goal,
            arm=self.arm.shape if arm is None else arm,
            topology=topology,
            apply=self.apply,
            apply_many=self.apply_many if self._workers > 1 or at_once else None,
            rng=rng,
            budget=budget,
            rejected=rejected,
            earlier=earlier,
            reach=reach,
            confirm=confirm,
            sample=sample,
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


def _ends_there(motion: Motion) -> bool:
    """Whether nothing follows a motion: it was followed to its end, or stopped as asked for."""
    return motion.complete or (motion.stopped is not None and motion.stopped.cause is not StopCause.WALL)


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
