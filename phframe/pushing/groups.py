"""The groups of obstacles that a search may push from one state: by persistent homology at every radius, and one by one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from phframe.core import IntArray, PersistenceDiagram
from phframe.pushing.grouping import closest_component
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.pushing import Pushing

Grouping = Literal["homology", "single"]
Radii = Literal["all", "smallest"]


@dataclass(frozen=True, slots=True, eq=False)
class ObstacleGroup:
    """The closest component at a radius.

    Attributes:
        chosen: Indices ``(k,)`` of its members among those of the problem.
        radius: At which it is one component (m); 0: an object alone.
        diagram: Of all members; None: it was not asked for.
        labels: The component of each member at the radius; None: not asked for.
    """

    chosen: IntArray
    radius: float = 0.0
    diagram: PersistenceDiagram | None = None
    labels: IntArray | None = None

    def told_in(self, decision: PushDecision) -> PushDecision:
        """A decision to push it, which says how it was grouped."""
        if self.labels is None:
            return replace(decision, why="the closest obstacle")
        why = f"the closest component at a radius of {1000 * self.radius:.0f} mm"
        return replace(decision, why=why, radius=self.radius, diagram=self.diagram, labels=self.labels)


def closest_groups(pushing: Pushing, problem: PushProblem, grouping: Grouping, radii: Radii) -> list[ObstacleGroup]:
    """The closest component at each radius that counts, and the closest object alone; each group once.

    Args:
        pushing: The geometry of the task.
        problem: With at least one member.
        grouping: ``homology``: at the usable radii, the threshold h and the last death; ``single``: one object alone.
        radii: ``smallest``: only PHIA's radius, the smallest usable one or h.
    """
    found: dict[tuple[int, ...], ObstacleGroup] = {}
    for group in _groups(pushing, problem, grouping, radii):
        found.setdefault(tuple(group.chosen.tolist()), group)
    return list(found.values())


def _groups(pushing: Pushing, problem: PushProblem, grouping: Grouping, radii: Radii) -> Iterator[ObstacleGroup]:
    local, axis = problem.local, problem.corridor.axis
    if grouping == "homology":
        diagram = pushing.diagram(problem)
        for radius in _radii(pushing, diagram, radii):
            labels = pushing.components(problem, radius)
            yield ObstacleGroup(closest_component(local, labels, axis), radius, diagram, labels)
    if grouping == "single" or radii == "all":
        yield ObstacleGroup(closest_component(local, np.arange(len(local)), axis))


def _radii(pushing: Pushing, diagram: PersistenceDiagram, radii: Radii) -> list[float]:
    usable = pushing.radii(diagram)
    if radii == "smallest":
        return (usable or [pushing.threshold])[:1]
    last = diagram.finite_deaths[-1:].tolist()
    return sorted({*usable, pushing.threshold, *last}, reverse=True)
