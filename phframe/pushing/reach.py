"""Straight reaches for a target, at any number of yaws at once: what obstructs them, and what they keep clear of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phframe.core import (
    MOUTH_CLEARANCE,
    Action,
    ActionKind,
    Contacts,
    FloatArray,
    GripperPath,
    Infeasible,
    Phase,
    PhaseRule,
    Shelf,
    State,
)
from phframe.geometry.arm_view import ArmView
from phframe.geometry.straight_motion import distances_on_way_in
from phframe.pushing.options import PushingOptions

Severity = tuple[bool, int]
"""Of what obstructs: objects, as many as there are, count less than walls. Nothing: ``FREE``."""
FREE: Severity = (False, 0)
TOUCHING = 1e-6
"""Objects at rest beside one another are apart, or in one another, by less than this (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """How the open gripper is put around a target.

    Attributes:
        past: How far the fingertips go past the target's centre (m).
        opening: Distance between the open fingers (m).
        tight: Whether there is a wider fit.
        view: The arm in the shelf, so far open.
    """

    past: float
    opening: float
    tight: bool
    view: ArmView


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What reaches for a target are looked for in.

    Attributes:
        shelf: The shelf.
        ids: Of all objects, in the scene's order.
        radii: Of all objects ``(n,)`` (m).
        met: Which objects the arm does not pass over ``(n,)``.
        row: Of the target among them.
        closed: Distance between the closed fingers (m).
        options: For clearances and speeds.
    """

    shelf: Shelf
    ids: tuple[str, ...]
    radii: FloatArray
    met: NDArray[np.bool_]
    row: int
    closed: float
    options: PushingOptions

    @property
    def radius(self) -> float:
        """Of the target (m)."""
        return float(self.radii[self.row])


class Reaches:
    """The straight reaches for a target with one fit, at several yaws; each is known by its place among the yaws.

    Args:
        around: The shelf and what is in it.
        state: The world at rest.
        fit: Of the gripper around the target.
        yaws: Of the arm in the shelf frame (rad).

    Attributes:
        yaws: As given.
        severities: Of what obstructs each of them.
    """

    def __init__(self, around: Surroundings, state: State, fit: Fit, yaws: tuple[float, ...]) -> None:
        self._around, self._fit, self.yaws = around, fit, yaws
        self._arm, walls = fit.view.silhouette(yaws), fit.view.walls(yaws)
        self._turns, self._ahead = walls.turns, walls.ahead
        self._positions, self._present = state.positions, state.on_board
        self._target = self._positions[around.row]
        self._present[around.row] = False
        self._counts = self._present & around.met
        self._tips = self._target + fit.past * self._ahead
        self._lengths = (self._tips[:, 0] + self._arm.front + MOUTH_CLEARANCE) / self._ahead[:, 0]
        self._from_corners, self._from_objects = self._distances()
        self._blocked = (self._from_objects < around.radii + around.options.neighbour_clearance) & self._counts
        self._walled = ~walls.lets_out(self._tips, self._lengths)
        counts = np.where(self._walled, 0, self._blocked.sum(axis=1))
        self.severities: list[Severity] = list(zip(self._walled.tolist(), counts.tolist(), strict=True))

    def _distances(self) -> tuple[FloatArray, FloatArray]:
        """Distances of the corners at the mouth ``(a, 2)``, and of the objects ``(a, n)``, from what the arm sweeps over (m)."""
        points = np.concatenate([[[0.0, 0.0], [0.0, self._around.shelf.width]], self._positions])
        local = (points - self._tips[:, None]) @ self._turns
        distances = distances_on_way_in(local, *self._fit.view.boxes, self._lengths).min(axis=1)
        return distances[:, :2], distances[:, 2:]

    def obstruction(self, row: int) -> Infeasible:
        """What obstructs a reach that is not free: walls, or the objects by name."""
        if self._walled[row]:
            return Infeasible(f"grasp blocked by a wall at yaw {math.degrees(self.yaws[row]):.0f} degrees")
        blockers = tuple(self._around.ids[each] for each in np.flatnonzero(self._blocked[row]))
        return Infeasible(f"grasp blocked by {', '.join(blockers)}", blockers)

    def clearance(self, row: int) -> float:
        """Least distance of the open arm from walls and from objects other than the target on its way in (m).

        Of a wall nearest is what is inside the shelf at the end of the way, or the corner at the mouth.
        """
        shelf = self._around.shelf
        x, y = (self._arm.parts[row].reshape(-1, 2) + self._tips[row]).T
        inside = y[x >= 0.0]
        walls = (inside.min(initial=np.inf), shelf.width - inside.max(initial=-np.inf), shelf.depth - x.max())
        objects = (self._from_objects[row] - self._around.radii)[self._counts]
        return float(min(*walls, *self._from_corners[row], objects.min(initial=np.inf)))

    def withdraws_between_walls(self, row: int) -> bool:
        """Whether arm and target stay between the side walls, thought on before the mouth, and the target meets no object."""
        (_, y), (_, end_y) = self._way_out(row)
        target_y, radius = float(self._target[1]), self._around.radius
        south, north = float(self._arm.lowest[row]), float(self._arm.highest[row])
        south, north = min(south, target_y - radius - y), max(north, target_y + radius - y)
        if min(y, end_y) + south < 0.0 or max(y, end_y) + north > self._around.shelf.width:
            return False
        behind, beside = ((self._positions - self._target) @ self._turns[row]).T
        met = (behind < 0.0) & (np.abs(beside) < self._around.radii + radius - TOUCHING) & self._present
        return not bool(met.any())

    def _way_out(self, row: int) -> tuple[list[float], list[float]]:
        """The fingertip at the target, and in the end, when the whole target is well outside the mouth ``(2,)`` (m)."""
        tip, ahead = self._tips[row], self._ahead[row]
        out = (float(self._target[0]) + self._around.radius + self._around.options.withdrawal) / ahead[0]
        end = tip - max(out, self._lengths[row]) * ahead
        return tip.tolist(), end.tolist()

    def action(self, row: int) -> Action:
        """Reach, close the fingers, draw straight out until the whole target is well outside the mouth."""
        (tip, end), yaw = self._way_out(row), self.yaws[row]
        start = (self._tips[row] - self._lengths[row] * self._ahead[row]).tolist()
        poses = np.array([(*place, yaw) for place in (start, tip, tip, end)])
        speed, closed = self._around.options.reach_speed, self._around.closed
        rules = {
            Phase.REACH: PhaseRule(speed, self._fit.opening, Contacts.MANIPULAND),
            Phase.GRASP: PhaseRule(speed, closed, Contacts.MANIPULAND),
            Phase.WITHDRAW: PhaseRule(speed, closed, Contacts.MANIPULAND),
        }
        target = self._around.ids[self._around.row]
        path = GripperPath(poses, (Phase.REACH, Phase.GRASP, Phase.WITHDRAW), rules, target)
        return Action(f"grasp {target}", path, (target,), ActionKind.GRASP)
