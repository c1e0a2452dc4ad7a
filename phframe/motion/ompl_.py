"""Sampling-based planning of joint paths by the planners of OMPL, repeatably and without a word on the console."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from phframe.core import FloatArray
from phframe.motion.biest_ import BiEST
from phframe.motion.edges import Edges

REACH = 0.1
"""Longest edge that a planner draws, as a fraction of the diagonal of the joint limits; measured, on Baxter at a shelf."""
BIEST_REACH = 0.14
"""The range of BiEST, likewise."""
SEEDS = 2**31
"""OMPL's seeds are below it, and above 0."""


def search(
    start: FloatArray,
    goals: FloatArray,
    limits: tuple[FloatArray, FloatArray],
    edges: Edges,
    planner: str,
    stop: Callable[[], bool],
    rng: np.random.Generator,
) -> FloatArray | None:
    """The path ``(k, dof)`` that a planner finds from a valid start to one of the valid goals ``(m, dof)``, or None.

    OMPL draws the seeds of all its generators from one generator of the process. It is seeded here, from ``rng``, right
    before anything draws from it, so that a search repeats whatever ran before; it stays as it is left. Other users of
    OMPL in the process who seed it themselves, as they must to repeat, notice nothing.

    Args:
        start: Joint values ``(dof,)``.
        goals: Joint values ``(m, dof)``.
        limits: Lower and upper joint limits ``(dof,)``.
        edges: Says what is valid. What it raises comes out of here as it is.
        planner: One of OMPL's class names, or BiEST.
        stop: Asked by the planner in each of its iterations.
        rng: The only source of randomness.
    """
    with _silence():
        ou.RNG.setSeed(int(rng.integers(1, SEEDS)))
        space = _space(limits)
        problem = _problem(space, edges, start, goals)
        chosen = _planner(planner, problem.getSpaceInformation(), space.getMaximumExtent(), rng)
        chosen.setProblemDefinition(problem)
        chosen.setup()
        chosen.solve(ob.PlannerTerminationCondition(stop))
        if not problem.hasExactSolution():
            return None
        return np.array([_values(state, len(start)) for state in problem.getSolutionPath().getStates()])


@contextmanager
def _silence() -> Iterator[None]:
    """Within it OMPL says nothing; afterwards as much as before."""
    level = ou.getLogLevel()
    ou.setLogLevel(ou.LOG_NONE)
    try:
        yield
    finally:
        ou.setLogLevel(level)


class _Motions(ob.MotionValidator):  # type: ignore[misc] # OMPL's types are there only where it is installed
    """What OMPL asks about edges."""

    def __init__(self, si: ob.SpaceInformation, edges: Edges, dof: int) -> None:
        super().__init__(si)
        self._edges, self._dof = edges, dof

    def checkMotion(self, start: Any, end: Any, *_: Any) -> bool:  # noqa: N802 # OMPL's name
        """Whether the edge is valid; of one that is not, no part is taken to be."""
        return self._edges.allowed(np.array(_values(start, self._dof)), np.array(_values(end, self._dof)))


def _space(limits: tuple[FloatArray, FloatArray]) -> ob.RealVectorStateSpace:
    space, bounds = ob.RealVectorStateSpace(len(limits[0])), ob.RealVectorBounds(len(limits[0]))
    for index, (lower, upper) in enumerate(np.transpose(limits).tolist()):
        bounds.setLow(index, lower)
        bounds.setHigh(index, upper)
    space.setBounds(bounds)
    return space


def _problem(space: ob.RealVectorStateSpace, edges: Edges, start: FloatArray, goals: FloatArray) -> Any:
    """The ProblemDefinition. Nothing that OMPL keeps a hold of refers back to it, so nothing stays behind."""
    si, dof = ob.SpaceInformation(space), len(start)
    si.setStateValidityChecker(lambda state: bool(edges.valid(np.array(_values(state, dof)))))
    si.setMotionValidator(_Motions(si, edges, dof))
    si.setup()
    problem, wanted, state = ob.ProblemDefinition(si), ob.GoalStates(si), si.allocState()
    problem.addStartState(_set(state, start))
    for goal in goals:
        wanted.addState(_set(state, goal))
    problem.setGoal(wanted)
    return problem


def _planner(name: str, si: ob.SpaceInformation, extent: float, rng: np.random.Generator) -> ob.Planner:
    """One of them, for joint limits whose diagonal is ``extent``."""
    if name == "BiEST":
        return BiEST(si, BIEST_REACH * extent, rng)
    planner = getattr(og, name)(si)
    if hasattr(planner, "setRange"):
        planner.setRange(REACH * extent)
    return planner


def _values(state: Any, dof: int) -> list[float]:
    """Index by index: OMPL's states know no end."""
    return [state[index] for index in range(dof)]


def _set(state: Any, values: Sequence[float] | FloatArray) -> Any:
    for index, value in enumerate(values):
        state[index] = float(value)
    return state
