"""Pushes of the target itself, where no finger fits beside it: away from a wall, or out from among its neighbours."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from phframe.core import FloatArray, State
from phframe.pushing.corridor import corridor_at
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.push_search import Proposal
from phframe.pushing.pushing import Pushing

ANGLES = tuple(math.radians(degrees) for degrees in (0, 15, -15, 30, -30))
"""Of the arm that pushes, in the shelf frame (rad)."""
DISTANCES = (0.03, 0.06)
"""How far the target is pushed aside (m)."""
PAST_TARGET = 1.0
"""How far past the target the corridor leads (m): it is what is pushed, and nothing to be kept off."""


def target_pushes(pushing: Pushing, state: State) -> Iterator[Proposal]:
    """The pushes of the target that fit, those that move it least first.

    Args:
        pushing: The geometry of the task.
        state: The world at rest.
    """
    row = pushing.scene.target_index
    target, radius = state.positions[row], float(pushing.scene.radii[row])
    for distance in DISTANCES:
        for angle in ANGLES:
            # What a sweep pushes ends one radius past the corridor's edge.
            corridor = corridor_at(angle, target, distance - radius, PAST_TARGET)
            members = np.array([row])
            problem = PushProblem(state, corridor, members, corridor.to_local(state.positions[members]))
            for push in pushing.sweeps(problem, np.array([0])):
                if _has_room(pushing, push, target, distance):
                    yield push


def _has_room(pushing: Pushing, push: Proposal, target: FloatArray, distance: float) -> bool:
    """Whether the target would still stand between the walls."""
    scene, sweep, corridor = pushing.scene, push[0].sweep, push[0].corridor
    if sweep is None or corridor is None:
        return False
    radius, y = float(scene.radii[scene.target_index]), target[1]
    pushed = float(y + sweep.direction * distance * math.cos(corridor.angle))
    return radius <= pushed <= scene.shelf.width - radius
