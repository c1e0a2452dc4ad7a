"""What a planner sees: one problem, and the means to try actions on it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from phframe.core.arm import ArmShape
from phframe.core.errors import BudgetExceededError, InputError
from phframe.core.gripper_path import Action
from phframe.core.motion import Transition
from phframe.core.plan import Cost, Plan
from phframe.core.scene import Scene
from phframe.core.state import State
from phframe.core.topology import PersistenceDiagram, TopologyEngine
from phframe.core.value import FloatArray, IntArray

Pair = tuple[State, Action]


@dataclass(frozen=True, slots=True)
class Budget:
    """How much a planner may spend. It is looked at before each simulation, which then runs to its end.

    Attributes:
        seconds: Wall time; the paper allows 300 s a problem.
        simulations: Number of simulated actions; None: no limit. Unlike seconds it ends runs repeatably.
    """

    seconds: float = 300.0
    simulations: int | None = None

    def __post_init__(self) -> None:
        if not self.seconds >= 0.0:
            raise InputError(f"a budget of {self.seconds!r} s is none: give a number of 0 or more")
        if self.simulations is not None and self.simulations < 0:
            raise InputError(f"a budget of {self.simulations!r} simulations is none: give 0 or more")


class Task:
    """One planning problem. Planners know nothing else: no backend, no arm model, no engine.

    Attributes:
        scene: Shelf, objects, target.
        start: The world to plan from; it need not be the scene's initial state.
        arm: The arm seen from above.
        rejected: Actions that could not be carried out; do not propose them again.
        rng: The only source of randomness.
        budget: What may be spent; ``apply`` keeps to it.
    """

    def __init__(
        self,
        *,
        scene: Scene,
        start: State,
        arm: ArmShape,
        topology: TopologyEngine[Any],
        apply: Callable[[State, Action], Transition],
        rng: np.random.Generator,
        apply_many: Callable[[Sequence[Pair]], Iterable[Transition]] | None = None,
        budget: Budget = Budget(),
        rejected: tuple[Action, ...] = (),
    ) -> None:
        self.scene, self.start, self.arm = scene, start, arm
        self.rejected, self.rng, self.budget = rejected, rng, budget
        self._apply, self._apply_many, self._topology = apply, apply_many, topology
        self._began = time.perf_counter()
        self._cost = Cost()
        self._offered: Plan | None = None

    def apply(self, state: State, action: Action) -> Transition:
        """What an action would make of a state: pure, from any state, in the planning world.

        Raises:
            BudgetExceededError: If the budget is spent. ``Planner.plan`` turns it into a result.
        """
        self._spend(1)
        began = time.perf_counter()
        try:
            return self._apply(state, action)
        finally:
            self._charge(simulation=time.perf_counter() - began, simulated_actions=1)

    def apply_many(self, pairs: Sequence[Pair]) -> list[Transition]:
        """``apply`` to many pairs, spread over workers where there are some; the results in the order of the pairs.

        Raises:
            BudgetExceededError: As ``apply``.
        """
        if self._apply_many is None:
            return [self.apply(state, action) for state, action in pairs]
        self._spend(len(pairs))
        began = time.perf_counter()
        try:
            return list(self._apply_many(pairs))
        finally:
            self._charge(simulation=time.perf_counter() - began, simulated_actions=len(pairs))

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        """The persistence diagram of points ``(n, 2)`` (m)."""
        began = time.perf_counter()
        try:
            return self._topology.diagram(points)
        finally:
            self._charge(topology=time.perf_counter() - began)

    def components(self, points: FloatArray, radius: float) -> IntArray:
        """Labels ``(n,)`` of the components of points ``(n, 2)`` at a radius (m)."""
        began = time.perf_counter()
        try:
            return self._topology.components(points, radius)
        finally:
            self._charge(topology=time.perf_counter() - began)

    def offer(self, plan: Plan) -> None:
        """Keep a plan as the result in case the budget runs out; the last one offered counts."""
        self._offered = plan

    @property
    def offered(self) -> Plan | None:
        """The plan last offered."""
        return self._offered

    @property
    def elapsed(self) -> float:
        """Wall time since the task was made (s)."""
        return time.perf_counter() - self._began

    @property
    def cost(self) -> Cost:
        """What has been spent so far."""
        return replace(self._cost, total=self.elapsed)

    def _spend(self, simulations: int) -> None:
        limit, budget = self.budget.simulations, self.budget
        if self.elapsed > budget.seconds:
            raise BudgetExceededError(f"the time limit of {budget.seconds:g} s is used up")
        if limit is not None and self._cost.simulated_actions + simulations > limit:
            raise BudgetExceededError(f"the budget of {limit} simulated actions is used up")

    def _charge(self, *, simulation: float = 0.0, topology: float = 0.0, simulated_actions: int = 0) -> None:
        self._cost += Cost(simulation=simulation, topology=topology, simulated_actions=simulated_actions)
