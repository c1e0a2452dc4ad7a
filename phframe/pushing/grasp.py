"""Reach, grasp and withdraw as one action: whether the gripper can get at the target, and how."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phframe.core import (
    MOUTH_CLEARANCE,
    Action,
    ActionKind,
    ArmShape,
    Contacts,
    GripperPath,
    Infeasible,
    Phase,
    PhaseRule,
    Scene,
    State,
    rotation_matrix,
)
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.geometry.arm_view import ArmView
from phframe.geometry.straight_motion import distances_on_way_in
from phframe.pushing.corridor import Corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import ROUNDING, PushingOptions

YAW_STEPS = tuple(math.radians(degrees) for degrees in (0, 5, -5, 10, -10, 15, -15, 20, -20, 25, -25, 30, -30))
"""Deviations from the corridor's axis, tried in this order as far as the options allow (rad)."""
FITS = ((0.02, 0.008), (0.01, 0.005), (0.004, 0.003))
"""How far the fingertips go past the target's centre, and the room between it and each open finger (m): wide first."""


@dataclass(frozen=True, slots=True)
class Grasp:
    """A reach, grasp and withdrawal that nothing blocks.

    Attributes:
        action: What to do.
        corridor: Along which the target was to be reached.
        deviations: The deviations it needed, by name.
    """

    action: Action
    corridor: Corridor
    deviations: tuple[Deviation, ...] = ()


def grasp_action(
    scene: Scene,
    state: State,
    corridor: Corridor,
    arm: ArmShape,
    options: PushingOptions,
    rejects: Callable[[Action], object] = lambda _: None,
) -> Grasp | Infeasible:
    """The reach along the corridor's axis, the grasp and the withdrawal, turned by up to 15 degrees past neighbours.

    The link must pass free of obstacles and walls (the paper's success). What obstructs the yaw with the fewest
    obstacles is named in the result.

    Args:
        scene: The scene.
        state: The world at rest.
        corridor: To the target.
        arm: Seen from above.
        options: For speeds, clearances and turns.
        rejects: Tells why an action is not to be proposed again; None: it may be.
    """
    radius = float(scene.radii[scene.target_index])
    least = Infeasible(f"the target is {2 * radius:g} m wide, too wide for a gripper that opens {arm.max_opening:g} m")
    for fit, (past, clearance) in enumerate(FITS):
        opening = 2.0 * (radius + clearance)
        if opening > arm.max_opening:
            continue
        view = ArmView(scene.shelf, arm.outlines(opening), options.neighbour_clearance)
        for yaw_offset in YAW_STEPS:
            if abs(yaw_offset) > options.max_grasp_turn + ROUNDING:
                continue
            if math.cos(corridor.angle + yaw_offset) < LEAST_AHEAD:
                continue
            reach = _Reach(scene, state, corridor.angle + yaw_offset, view, past, options)
            obstruction = reach.obstruction()
            if obstruction is None:
                action = reach.action(opening, radius, arm.min_opening)
                if rejects(action) is None:
                    return Grasp(action, corridor, _deviations(fit, yaw_offset))
                obstruction = Infeasible("every grasp that nothing blocks was rejected")
            least = min(obstruction, least, key=_severity)
    return least


def _deviations(fit: int, yaw_offset: float) -> tuple[Deviation, ...]:
    turned = (Deviation.GRASP_TURNED,) if yaw_offset else ()
    return (*turned, Deviation.GRASP_TIGHT) if fit else turned


def _severity(obstruction: Infeasible) -> tuple[bool, int]:
    """Obstructing objects count less than walls, few less than many."""
    return not obstruction.blockers, len(obstruction.blockers)


class _Reach:
    """A straight reach at one yaw."""

    def __init__(
        self, scene: Scene, state: State, yaw: float, view: ArmView, past: float, options: PushingOptions
    ) -> None:
        self._scene, self._state, self._yaw, self._options = scene, state, yaw, options
        self._view, self._boxes = view, view.boxes
        self._target = state.positions[scene.target_index]
        self._ahead = np.array([math.cos(yaw), math.sin(yaw)])
        self._tip = self._target + past * self._ahead
        front = view.silhouette(yaw).front
        self._length = (float(self._tip[0]) + front + MOUTH_CLEARANCE) / self._ahead[0]

    def obstruction(self) -> Infeasible | None:
        """What obstructs the reach: walls, or the objects by name."""
        start = self._tip - self._length * self._ahead
        walls = self._view.walls(self._yaw)
        if walls.travel(start, self._ahead, self._length) < self._length:
            return Infeasible(f"grasp blocked by a wall at yaw {math.degrees(self._yaw):.0f} degrees")
        blockers = tuple(self._scene.ids[row] for row in np.flatnonzero(self._blocked()))
        return Infeasible(f"grasp blocked by {', '.join(blockers)}", blockers) if blockers else None

    def _blocked(self) -> NDArray[np.bool_]:
        """Mask ``(n,)`` of the objects that the arm would touch on its way in."""
        local = (self._state.positions - self._tip) @ rotation_matrix(self._yaw)
        lower, upper = self._boxes
        distance = distances_on_way_in(local, lower, upper, self._length).min(axis=0)
        distance[self._scene.target_index] = np.inf
        return np.asarray((distance < self._scene.radii + self._options.neighbour_clearance) & self._state.on_board)

    def action(self, opening: float, radius: float, closed: float) -> Action:
        """Reach, close the fingers, draw straight out until the whole target is well outside the mouth."""
        out = (float(self._target[0]) + radius + self._options.withdrawal) / self._ahead[0]
        start = self._tip - self._length * self._ahead
        end = self._tip - max(out, self._length) * self._ahead
        poses = np.column_stack([np.array([start, self._tip, self._tip, end]), np.full(4, self._yaw)])
        speed = self._options.reach_speed
        rules = {
            Phase.REACH: PhaseRule(speed, opening, Contacts.MANIPULAND),
            Phase.GRASP: PhaseRule(speed, closed, Contacts.MANIPULAND),
            Phase.WITHDRAW: PhaseRule(speed, closed, Contacts.MANIPULAND),
        }
        target = self._scene.target
        path = GripperPath(poses, (Phase.REACH, Phase.GRASP, Phase.WITHDRAW), rules, target)
        return Action(f"grasp {target}", path, (target,), ActionKind.GRASP)
