"""BiEST, two expansive space trees that grow towards one another, as a planner of OMPL, whose Python module has none."""

from __future__ import annotations

from typing import Any

import numpy as np
from ompl import base as ob
from ompl import geometric as og

from phframe.core import FloatArray
from phframe.motion.expansive_tree import ExpansiveTree

DENSITY = 1.0 / 3.0
"""Radius within which vertices count as neighbours, as a fraction of the range."""


class BiEST(ob.Planner):  # type: ignore[misc] # OMPL's types are there only where it is installed
    """Bidirectional expansive space trees, in a space of real vectors with bounds.

    In turn, one tree grows: a vertex is picked with a probability proportional to 1 / (its neighbours + 1), a
    configuration is drawn evenly from the box of half-width ``reach`` about it, and kept with the probability 1 / (its
    neighbours) if it can be reached straight. From there, all vertices of the other tree within ``reach`` are tried,
    the nearest first; the first that can be reached straight makes the path.

    Source: D. Hsu, J.-C. Latombe, R. Motwani, "Path planning in expansive configuration spaces", International Journal
    of Computational Geometry and Applications 9 (1999); with the weights and radii of OMPL's BiEST in C++. As in the
    paper, and unlike there, density is judged before collisions are looked for, which costs far more.

    Args:
        si: The space, and what is valid in it.
        reach: Range (rad or m).
        rng: The only source of randomness.
    """

    def __init__(self, si: ob.SpaceInformation, reach: float, rng: np.random.Generator) -> None:
        super().__init__(si, "BiEST")
        bounds, self._dof = si.getStateSpace().getBounds(), si.getStateDimension()
        self._lower, self._upper = (np.array([side[i] for i in range(self._dof)]) for side in (bounds.low, bounds.high))
        self._reach, self._rng = reach, rng
        self._from, self._to = si.allocState(), si.allocState()
        self._plant()

    @property
    def trees(self) -> tuple[ExpansiveTree, ExpansiveTree]:
        """The one that grows from the starts, and the one from the goals."""
        return self._trees

    def clear(self) -> None:
        """Forget the trees."""
        super().clear()
        self._plant()

    def solve(self, stop: ob.PlannerTerminationCondition) -> ob.PlannerStatus:
        """Grow until the trees meet or ``stop`` says so; a second call goes on from there."""
        self.checkValidity()
        self._take_inputs()
        starts, goals = self._trees
        if not starts.size:
            return ob.PlannerStatus(ob.PlannerStatus.INVALID_START)
        if not goals.size:
            return ob.PlannerStatus(ob.PlannerStatus.INVALID_GOAL)
        while not stop.eval():
            path = self._grown()
            if path is not None:
                self.getProblemDefinition().addSolutionPath(self._as_path(path), False, 0.0, self.getName())
                return ob.PlannerStatus(ob.PlannerStatus.EXACT_SOLUTION)
        return ob.PlannerStatus(ob.PlannerStatus.TIMEOUT)

    def _plant(self) -> None:
        self._trees = (self._tree(), self._tree())
        self._turn = 0

    def _tree(self) -> ExpansiveTree:
        return ExpansiveTree(self._dof, DENSITY * self._reach)

    def _take_inputs(self) -> None:
        """Plant the valid starts and goals that are new."""
        inputs = self.getPlannerInputStates()
        for tree, following in zip(self._trees, (inputs.nextStart, inputs.nextGoal), strict=True):
            while (state := following()) is not None:
                tree.add(self._values(state))

    def _grown(self) -> FloatArray | None:
        """The path ``(k, dof)`` if the tree whose turn it is grew and met the other."""
        tree, other = self._trees[self._turn], self._trees[1 - self._turn]
        parent = tree.picked(self._rng.random())
        q = self._drawn_near(tree.vertices[parent])
        if self._rng.random() >= tree.acceptance(q):
            return None  # still its turn, as in OMPL
        self._turn = 1 - self._turn
        if not self._is_edge(tree.vertices[parent], q):
            return None
        vertex = tree.add(q, parent)
        met = next((v for v in other.near(q, self._reach).tolist() if self._is_edge(q, other.vertices[v])), None)
        return None if met is None else self._joined(*((vertex, met) if tree is self._trees[0] else (met, vertex)))

    def _joined(self, ahead: int, behind: int) -> FloatArray:
        """The path that leads through a vertex of the one tree to one of the other."""
        return np.concatenate([self._trees[0].branch(ahead)[::-1], self._trees[1].branch(behind)])

    def _drawn_near(self, q: FloatArray) -> FloatArray:
        """Even in the box about ``q``, cut off at the bounds."""
        box = np.maximum(self._lower, q - self._reach), np.minimum(self._upper, q + self._reach)
        return np.asarray(self._rng.uniform(*box))

    def _is_edge(self, start: FloatArray, end: FloatArray) -> bool:
        for state, values in ((self._from, start), (self._to, end)):
            for index, value in enumerate(values.tolist()):
                state[index] = value
        return bool(self.getSpaceInformation().checkMotion(self._from, self._to))

    def _as_path(self, waypoints: FloatArray) -> og.PathGeometric:
        path = og.PathGeometric(self.getSpaceInformation())
        for values in waypoints.tolist():
            for index, value in enumerate(values):
                self._from[index] = value
            path.append(self._from)
        return path

    def _values(self, state: Any) -> FloatArray:
        return np.array([state[index] for index in range(self._dof)])
