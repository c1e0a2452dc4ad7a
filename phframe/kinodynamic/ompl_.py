"""Search among controls by OMPL's RRT and KPIECE1, over steering: repeatable, and without a word on the console.

OMPL's states hold the coordinates that distances are measured in, and the index of a snapshot, which counts for nothing
in a distance. So OMPL copies and compares plain numbers, and the worlds stay where they were made.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal

import numpy as np
from ompl import base as ob
from ompl import control as oc
from ompl import util as ou

from phframe.core import FloatArray
from phframe.kinodynamic.region import Region
from phframe.kinodynamic.steered_tree import Controls, SteeredTree

SEEDS = 2**31
"""OMPL's seeds are below it, and above 0."""
MOST_SNAPSHOTS = 1e9
"""An index in OMPL's states is below it."""


ControlSearch = Literal["rrt", "kpiece1"]
"""Rapidly exploring random tree (LaValle and Kuffner 2001), or kinodynamic planning by interior-exterior cell exploration
(Sucan and Kavraki 2009)."""

_PLANNERS = {"rrt": oc.RRT, "kpiece1": oc.KPIECE1}


def search_controls(
    tree: SteeredTree,
    region: Region,
    controls: Controls,
    *,
    search: ControlSearch,
    goal_bias: float,
    most: int,
    rng: np.random.Generator,
) -> int | None:
    """Grow a tree until it reaches a region; the index of the node that does, or None.

    OMPL draws the seeds of all its generators from one generator of the process. It is seeded here, from ``rng``, right
    before anything draws from it, so that a search repeats whatever ran before.

    Args:
        tree: With its root alone.
        region: Where to get.
        controls: What to choose from.
        search: How.
        goal_bias: Of RRT: how often it aims at the region. OMPL's Python module cannot set KPIECE1's, which is 0.05.
        most: How many controls are tried at most.
        rng: The only source of randomness.

    Raises:
        BudgetExceededError: If the task's budget is spent.
    """
    if region.reached(tree[0].state):
        return 0
    with _silence():
        ou.RNG.setSeed(int(rng.integers(1, SEEDS)))
        problem = _problem(tree, region, controls, search, rng)
        planner = _PLANNERS[search](problem.getSpaceInformation())
        if search == "rrt":
            planner.setGoalBias(goal_bias)
        planner.setProblemDefinition(problem)
        planner.setup()
        planner.solve(ob.PlannerTerminationCondition(lambda: tree.tried >= most))
        if not problem.hasExactSolution():
            return None
        return _index(problem.getSolutionPath().getStates()[-1])


@contextmanager
def _silence() -> Iterator[None]:
    """Within it OMPL says nothing; afterwards as much as before."""
    level = ou.getLogLevel()
    ou.setLogLevel(ou.LOG_NONE)
    try:
        yield
    finally:
        ou.setLogLevel(level)


def _problem(
    tree: SteeredTree, region: Region, controls: Controls, search: ControlSearch, rng: np.random.Generator
) -> Any:
    """The ProblemDefinition: one control held for one step at a time."""
    space = _state_space(region)
    si = oc.SpaceInformation(space, _control_space(space, controls))
    si.setStatePropagator(_Propagation(tree, region))
    si.setStateValidityChecker(lambda state: not tree[_index(state)].fault)
    si.setPropagationStepSize(controls.step)
    si.setMinMaxControlDuration(1, 1)
    if search == "kpiece1":
        space.registerDefaultProjection(_Plain(space, len(region.lower)))
    si.setup()
    problem, start = ob.ProblemDefinition(si), si.allocState()
    _write(start, region.coordinates(tree[0].state), 0)
    problem.addStartState(start)
    problem.setGoal(_Goal(si, region, rng))
    return problem


def _state_space(region: Region) -> ob.CompoundStateSpace:
    """The region's coordinates, and an index that counts for nothing in a distance."""
    whole = ob.CompoundStateSpace()
    whole.addSubspace(_real_vectors(region.lower, region.upper), 1.0)
    whole.addSubspace(_real_vectors(np.zeros(1), np.full(1, MOST_SNAPSHOTS)), 0.0)
    return whole


def _real_vectors(lower: FloatArray, upper: FloatArray) -> ob.RealVectorStateSpace:
    space = ob.RealVectorStateSpace(len(lower))
    space.setBounds(_bounds(lower, upper))
    return space


def _control_space(space: ob.CompoundStateSpace, controls: Controls) -> oc.RealVectorControlSpace:
    twists = oc.RealVectorControlSpace(space, 3)
    twists.setBounds(_bounds(-controls.limits, controls.limits))
    return twists


def _bounds(lower: FloatArray, upper: FloatArray) -> ob.RealVectorBounds:
    bounds = ob.RealVectorBounds(len(lower))
    for index, (least, most) in enumerate(zip(lower.tolist(), upper.tolist(), strict=True)):
        bounds.setLow(index, least)
        bounds.setHigh(index, most)
    return bounds


class _Propagation:
    """What OMPL asks to hold a control. What it raises comes out of the search as it is."""

    def __init__(self, tree: SteeredTree, region: Region) -> None:
        self._tree, self._region = tree, region

    def __call__(self, start: Any, control: Any, duration: float, end: Any) -> None:
        twist = np.array([control[axis] for axis in range(3)])
        index = self._tree.extend(_index(start), twist)
        _write(end, self._region.coordinates(self._tree[index].state), index)


class _Goal(ob.GoalSampleableRegion):  # type: ignore[misc] # OMPL's types are there only where it is installed
    """What OMPL asks about the region."""

    def __init__(self, si: oc.SpaceInformation, region: Region, rng: np.random.Generator) -> None:
        super().__init__(si)
        self._region, self._rng = region, rng
        self.setThreshold(region.tolerance)

    def distanceGoal(self, state: Any) -> float:  # noqa: N802 # OMPL's name
        """How far a state is from the middle of the region (m)."""
        return self._region.distance(_read(state, len(self._region.lower)))

    def sampleGoal(self, state: Any) -> None:  # noqa: N802 # OMPL's name
        """Make a state one of the region."""
        _write(state, self._region.sample(self._rng), 0)

    def maxSampleCount(self) -> int:  # noqa: N802 # OMPL's name
        """As many as there are asked for."""
        return 2**31 - 1


class _Plain(ob.ProjectionEvaluator):  # type: ignore[misc] # OMPL's types are there only where it is installed
    """KPIECE1's cells: the coordinates themselves; OMPL infers the sizes of the cells, a twentieth of each range."""

    def __init__(self, space: ob.CompoundStateSpace, dimension: int) -> None:
        super().__init__(space)
        self._dimension = dimension

    def getDimension(self) -> int:  # noqa: N802 # OMPL's name
        """How many coordinates there are."""
        return self._dimension

    def project(self, state: Any, projection: FloatArray) -> None:
        """Write down a state's coordinates."""
        projection[: self._dimension] = _read(state, self._dimension)


def _index(state: Any) -> int:
    return int(state[1][0])


def _read(state: Any, dimension: int) -> FloatArray:
    """Index by index: OMPL's states know no end."""
    return np.array([state[0][axis] for axis in range(dimension)])


def _write(state: Any, coordinates: FloatArray, index: int) -> None:
    for axis, value in enumerate(coordinates.tolist()):
        state[0][axis] = value
    state[1][0] = float(index)
