"""What a planner sees: one problem, and the means to try actions on it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from phframe.core.action import Action
from phframe.core.advisor import NOBODY, Advisor, Hint, Question
from phframe.core.arm import ArmShape
from phframe.core.errors import BudgetExceededError, InputError
from phframe.core.explored_tree import ExploredTree
from phframe.core.goal import Goal
from phframe.core.motion import Transition
from phframe.core.particle import Apply, Particle
from phframe.core.physics import Stop, SupportsPropagation
from phframe.core.plan import Cost, Plan
from phframe.core.rejection import Rejection
from phframe.core.scene import Scene
from phframe.core.search_tree import SearchTree
from phframe.core.state import State
from phframe.core.steering import Begin, Steering
from phframe.core.topology import PersistenceDiagram, TopologyEngine
from phframe.core.unreachable import Unreachable
from phframe.core.value import FloatArray, IntArray

Pair = tuple[State, Action]
ResultT = TypeVar("ResultT")


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


ApplyMany = Callable[[Sequence[Pair], Stop | None], Iterable[Transition]]
Sample = Callable[[int], Sequence[Particle]]
"""As many samples of the world at the task's start as are asked for."""
Reach = Callable[[State, Action], Unreachable | None]
"""Whether the arm that will carry an action out can, from a state; None: it can."""
ObjectReach = Callable[[State, str], Unreachable | None]
"""Whether the arm that will carry the plan out can have an object grasped where it stands in a state; None: it can."""


class Task:
    """One planning problem. Planners know nothing else: no backend, no arm model, no engine.

    Attributes:
        scene: Shelf, objects, target.
        start: The world to plan from; it need not be the scene's initial state.
        goal: What is to be achieved.
        arm: The arm seen from above.
        rejected: Actions that could not be carried out or came to nothing, and why; see ``rejects``.
        earlier: What the plan before this one had tried from where its last action that was carried out was to lead: a tree
            whose root is the state that was expected there. None: this is the first plan.
        rng: The only source of randomness.
        budget: What may be spent; ``apply`` keeps to it.
    """

    def __init__(
        self,
        *,
        scene: Scene,
        start: State,
        goal: Goal[Any],
        arm: ArmShape,
        topology: TopologyEngine[Any],
        apply: Apply,
        rng: np.random.Generator,
        apply_many: ApplyMany | None = None,
        budget: Budget = Budget(),
        rejected: tuple[Rejection, ...] = (),
        earlier: ExploredTree | None = None,
        reach: Reach | None = None,
        confirm: Apply | None = None,
        sample: Sample | None = None,
        object_reach: ObjectReach | None = None,
        steered: SupportsPropagation[Any] | None = None,
        begin_steering: Begin | None = None,
        advisor: Advisor = NOBODY,
    ) -> None:
        self.scene, self.start, self.goal, self.arm = scene, start, goal, arm
        self.rejected, self.earlier, self.rng, self.budget = rejected, earlier, rng, budget
        self._limits = replace(budget)
        self._confirm, self._sample = confirm, sample
        self._apply, self._apply_many, self._topology = apply, apply_many, topology
        self._reach, self._steered, self._begin_steering = reach, steered, begin_steering
        self._object_reach = object_reach
        self._advisor, self._began = advisor, time.perf_counter()
        self._cost = Cost()
        self._offered: Plan | None = None
        self._first_solution_time: float | None = None
        self._tree: SearchTree | None = None

    def apply(self, state: State, action: Action, *, stop: Stop | None = None) -> Transition:
        """What an action would make of a state: pure, from any state, in the planning world.

        Args:
            state: Any state.
            action: What is done. One that the planning arm cannot do changes nothing; the motion says why.
            stop: When to end early, such as at the first contact with some objects; the arm then stands where it is.

        Raises:
            BudgetExceededError: If the budget is spent. ``Planner.plan`` turns it into a result.
        """
        return self._simulated(lambda: self._apply(state, action, stop))

    def apply_many(self, pairs: Sequence[Pair], *, stop: Stop | None = None) -> list[Transition]:
        """``apply`` to many pairs, spread over workers where there are some; the results in the order of the pairs.

        Raises:
            BudgetExceededError: As ``apply``; before any is simulated, where the budget does not allow all of them.
        """
        if (many := self._apply_many) is None:
            self._spend(len(pairs))
            return [self.apply(state, action, stop=stop) for state, action in pairs]
        return self._simulated(lambda: list(many(pairs, stop)), len(pairs))

    @property
    def confirms(self) -> bool:
        """Whether actions can be simulated in the engine that will execute them, which is another than the planning world's."""
        return self._confirm is not None

    def confirm(self, state: State, action: Action) -> Transition:
        """``apply`` in the engine that will execute the plan, and by its arm; without one, in the planning world.

        Args:
            state: The state; one that this returned holds the arm where it stands then.
            action: What is done. One that the arm cannot do changes nothing; the motion says why.
        """
        confirm = self._confirm or self._apply
        return self._simulated(lambda: confirm(state, action, None))

    def particles(self, number: int) -> tuple[Particle, ...]:
        """Samples of what the world may be at the task's start; none where what is believed of it is certain.

        Each applies actions within the budget, as ``apply`` does.
        """
        drawn = self._sample(number) if self._sample is not None else ()
        return tuple(replace(particle, apply=self._within_budget(particle.apply)) for particle in drawn)

    def _within_budget(self, apply: Apply) -> Apply:
        return lambda state, action, stop: self._simulated(lambda: apply(state, action, stop))

    def rejects(self, action: Action) -> Rejection | None:
        """Why an action is not to be proposed (again); None: it may be. Deviations below a millimetre do not count."""
        return next((rejection for rejection in self.rejected if rejection.action.resembles(action)), None)

    def reachable(self, action: Action, state: State | None = None) -> Unreachable | None:
        """Whether the arm that will carry an action out can follow it: None if so, else where and why not.

        Where that arm is driven by its joints this plans their motion, which takes tenths of a second; where its outline
        is moved, it asks its inverse kinematics. What it takes counts as motion planning.

        Args:
            action: The action.
            state: From which it begins; None: the task's start.
        """
        if self._reach is None:
            return None
        began = time.perf_counter()
        try:
            return self._reach(self.start if state is None else state, action)
        finally:
            self._cost += Cost(motion_planning=time.perf_counter() - began)

    def out_of_reach(self, object_id: str, state: State | None = None) -> Unreachable | None:
        """Why the arm that will carry the plan out can have an object grasped at no yaw, even in an empty shelf.

        None: there is a yaw, or it is not known. Takes some tenths of a second where there is one, and seconds where
        there is none; counts as motion planning.

        Args:
            object_id: The object.
            state: In which it stands where it does; None: the task's start.
        """
        if self._object_reach is None:
            return None
        began = time.perf_counter()
        try:
            return self._object_reach(self.start if state is None else state, object_id)
        finally:
            self._cost += Cost(motion_planning=time.perf_counter() - began)

    @property
    def steering(self) -> Steering[Any] | None:
        """Control-level steering of the planning world's gripper; None where the world has none."""
        if self._steered is None or self._begin_steering is None:
            return None
        return Steering(self._steered, self._begin_steering, self._simulated)

    @contextmanager
    def paused(self) -> Iterator[None]:
        """The clock stands still in this ``with``: for what is no planning, such as watching a planner or asking somebody."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self._began += time.perf_counter() - began

    def ask(self, question: Question) -> Hint | None:
        """What whoever can be asked says is to be moved next; None: there is no hint. The clock stands still meanwhile."""
        with self.paused():
            return self._advisor.advise(question)

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        """The persistence diagram of points ``(n, 2)`` (m)."""
        began = time.perf_counter()
        try:
            return self._topology.diagram(points)
        finally:
            self._cost += Cost(topology=time.perf_counter() - began)

    def components(self, points: FloatArray, radius: float) -> IntArray:
        """Labels ``(n,)`` of the components of points ``(n, 2)`` at a radius (m)."""
        began = time.perf_counter()
        try:
            return self._topology.components(points, radius)
        finally:
            self._cost += Cost(topology=time.perf_counter() - began)

    def search_tree(self) -> SearchTree:
        """A tree that begins at the task's start. Should the budget run out, what was tried is told by the last one made."""
        self._tree = SearchTree(self.start)
        return self._tree

    @property
    def explored(self) -> ExploredTree | None:
        """What was tried so far, with the deepest path as the chosen one; None where no tree was asked for."""
        return None if self._tree is None else self._tree.explored(self._tree.deepest)

    def offer(self, plan: Plan) -> None:
        """Keep a plan as the result in case the budget runs out; the last one offered counts."""
        self._offered = plan
        if self._first_solution_time is None and plan.succeeded:
            self._first_solution_time = self.elapsed

    @property
    def offered(self) -> Plan | None:
        """The plan last offered."""
        return self._offered

    @property
    def first_solution_time(self) -> float | None:
        """Wall time until a plan that is worth carrying out was first offered (s); None: none was."""
        return self._first_solution_time

    @property
    def elapsed(self) -> float:
        """Wall time since the task was made (s)."""
        return time.perf_counter() - self._began

    @property
    def cost(self) -> Cost:
        """What has been spent so far."""
        return replace(self._cost, total=self.elapsed)

    @property
    def simulations_left(self) -> int | None:
        """How many actions may still be simulated; None: any number."""
        limit = self._limits.simulations
        return None if limit is None else limit - self._cost.simulated_actions

    def _spend(self, simulations: int) -> None:
        budget, left = self._limits, self.simulations_left
        if self.elapsed > budget.seconds:
            raise BudgetExceededError(f"the time limit of {budget.seconds:g} s is used up")
        if left is not None and simulations > left:
            raise BudgetExceededError(f"the budget of {budget.simulations} simulated actions is used up")

    def _simulated(self, simulate: Callable[[], ResultT], simulations: int = 1) -> ResultT:
        """Simulate within the budget, and count it."""
        self._spend(simulations)
        began = time.perf_counter()
        try:
            return simulate()
        finally:
            self._cost += Cost(simulation=time.perf_counter() - began, simulated_actions=simulations)
