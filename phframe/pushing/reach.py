"""Reach, grasp and withdraw as one action: whether the gripper can get at the target, and how."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from phframe.core import (
    Action,
    ArmShape,
    Contacts,
    Corridor,
    FloatArray,
    GripperPath,
    Infeasible,
    Outline,
    Phase,
    PhaseRule,
    Scene,
    State,
    turn,
)
from phframe.pushing.clearance import WallClearance
from phframe.pushing.options import PushingOptions

YAW_STEPS = tuple(math.radians(degrees) for degrees in (0, 5, -5, 10, -10, 15, -15))
"""Deviations from the corridor's axis, tried in this order (rad)."""
FITS = ((0.02, 0.008), (0.01, 0.005), (0.004, 0.003))
"""How far the fingertips go past the target's centre, and the room between it and each open finger (m): wide first."""
NEIGHBOUR_CLEARANCE = 0.002
"""Between the reaching arm and what it must not touch (m)."""
MOUTH_CLEARANCE = 0.05
"""How far before the mouth plane the arm starts (m)."""
OUTSIDE = 0.10
"""How far outside the mouth the whole target is drawn (m)."""


def grasp_action(
    scene: Scene, state: State, corridor: Corridor, arm: ArmShape, options: PushingOptions
) -> Action | Infeasible:
    """The reach along the corridor's axis, the grasp and the withdrawal, turned by up to 15 degrees past neighbours.

    The link must pass free of obstacles and walls (the paper's success). What is in the way of the yaw with the fewest
    obstacles is named in the result.
    """
    radius = float(scene.radii[scene.target_index])
    least = Infeasible(f"the target is {2 * radius:g} m wide, too wide for a gripper that opens {arm.max_opening:g} m")
    for (past, clearance), deviation in product(FITS, YAW_STEPS):
        opening = 2.0 * (radius + clearance)
        if opening > arm.max_opening:
            continue
        reach = _Reach(scene, state, corridor.angle + deviation, arm.outlines(opening), past)
        obstruction = reach.obstruction()
        if obstruction is None:
            return reach.action(opening, radius, arm.min_opening, options)
        least = min(obstruction, least, key=_severity)
    return least


def _severity(obstruction: Infeasible) -> tuple[bool, int]:
    """Objects in the way are less of an obstacle than walls, few less than many."""
    return not obstruction.blockers, len(obstruction.blockers)


class _Reach:
    """A straight reach at one yaw."""

    def __init__(self, scene: Scene, state: State, yaw: float, outlines: Sequence[Outline], past: float) -> None:
        self._scene, self._state, self._yaw, self._outlines = scene, state, yaw, outlines
        self._target = state.positions[scene.target_index]
        self._ahead = np.array([math.cos(yaw), math.sin(yaw)])
        self._tip = self._target + past * self._ahead
        front = max(float((outline.vertices @ turn(yaw).T)[:, 0].max()) for outline in outlines)
        self._length = (float(self._tip[0]) + front + MOUTH_CLEARANCE) / self._ahead[0]

    def obstruction(self) -> Infeasible | None:
        """What is in the way: walls, or the objects by name."""
        start = self._tip - self._length * self._ahead
        walls = WallClearance(self._scene.shelf, self._outlines, self._yaw, NEIGHBOUR_CLEARANCE)
        if walls.travel(start, self._ahead, self._length) < self._length:
            return Infeasible(f"grasp blocked by a wall at yaw {math.degrees(self._yaw):.0f} degrees")
        blockers = tuple(self._scene.ids[row] for row in np.flatnonzero(self._blocked()))
        return Infeasible(f"grasp blocked by {', '.join(blockers)}", blockers) if blockers else None

    def _blocked(self) -> NDArray[np.bool_]:
        """Mask ``(n,)`` of the objects that the arm would touch on its way in."""
        local = (self._state.positions - self._tip) @ turn(self._yaw)
        reach = self._scene.radii + NEIGHBOUR_CLEARANCE
        hit = np.zeros(len(local), dtype=bool)
        for outline in self._outlines:
            hit |= _distance(local, outline.vertices, self._length) < reach
        hit[self._scene.target_index] = False
        return hit & self._state.on_board

    def action(self, opening: float, radius: float, closed: float, options: PushingOptions) -> Action:
        """Reach, close the fingers, draw straight out until the whole target is well outside the mouth."""
        out = (float(self._target[0]) + radius + OUTSIDE) / self._ahead[0]
        start = self._tip - self._length * self._ahead
        end = self._tip - max(out, self._length) * self._ahead
        poses = np.column_stack([np.array([start, self._tip, self._tip, end]), np.full(4, self._yaw)])
        rules = {
            Phase.REACH: PhaseRule(options.reach_speed, opening, Contacts.TARGET),
            Phase.GRASP: PhaseRule(options.reach_speed, closed, Contacts.TARGET),
            Phase.WITHDRAW: PhaseRule(options.reach_speed, closed, Contacts.TARGET),
        }
        path = GripperPath(poses, (Phase.REACH, Phase.GRASP, Phase.WITHDRAW), rules)
        return Action(f"grasp {self._scene.target}", path, (self._scene.target,))


def _distance(points: FloatArray, vertices: FloatArray, length: float) -> FloatArray:
    """Distances ``(n,)`` of points from the region that an outline covers on a straight way in of a length (m).

    The region is bounded by the box around the outline, drawn back along the way: outlines are convex and narrow ahead,
    so the box is a close and safe bound.
    """
    lower, upper = vertices.min(axis=0), vertices.max(axis=0)
    outside = np.maximum(np.maximum(lower - [length, 0.0] - points, points - upper), 0.0)
    return np.asarray(np.hypot(outside[:, 0], outside[:, 1]))
