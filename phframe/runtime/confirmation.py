"""Simulates actions in the engine that will execute them, for planners that want a plan confirmed before the arm moves."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from phframe.core import Action, State, Stop, Transition
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec


class Confirmation:
    """A world like the one that plans are carried out in, built when it is first asked. Use it in a ``with``.

    It is as the planner believes the world to be: what noise hides from the planner is not in it.

    Args:
        spec: What to build.
    """

    def __init__(self, spec: WorldSpec) -> None:
        self._spec = spec
        self._world: PlanningWorld | None = None

    def apply(self, state: State, action: Action, stop: Stop | None = None) -> Transition:
        """What an action makes of a state: a function of the two alone."""
        if self._world is None:
            self._world = PlanningWorld(self._spec)
        return self._world.apply(state, action, stop)

    @property
    def motion_planning_time(self) -> float:
        """Wall time spent on motion planning so far (s)."""
        return 0.0 if self._world is None else self._world.motion_planning_time

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._world is not None:
            self._world.close()
