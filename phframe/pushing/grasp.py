"""Reach, grasp and withdraw as one action: whether the gripper can get at the target, and how."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, chain

from phframe.core import Action, ArmShape, Infeasible, Scene, Shelf, State
from phframe.core.arm import FINGER_ROOM
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.geometry.arm_view import ArmView
from phframe.pushing.corridor import Corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.options import ROUNDING, PushingOptions
from phframe.pushing.reach import FREE, Fit, Reaches, Severity, Surroundings

YAW_STEPS = tuple(math.radians(degrees) for degrees in (0, 5, -5, 10, -10, 15, -15, 20, -20, 25, -25, 30, -30))
"""Deviations from the corridor's axis, tried in this order as far as the options allow (rad)."""
FITS = ((0.02, 0.008), (0.01, 0.005), (0.004, FINGER_ROOM))
"""How far the fingertips go past the target's centre, and the room between it and each open finger (m): wide first."""
KEPT_FITS = 16
"""For how many pairs of an arm and a target the views are kept: those used last."""
REJECTED = Infeasible("every grasp that nothing blocks was rejected")

Rejects = Callable[[Action], object]
"""Tells why an action is not to be proposed again; None: it may be."""


@dataclass(frozen=True, slots=True)
class Grasp:
    """A reach, grasp and withdrawal that nothing blocks.

    Attributes:
        action: What to do.
        corridor: Along which the target was to be reached.
        clearance: Least distance of the open arm from walls and from objects other than the target, on its way in (m).
        withdraws_between_walls: Whether on the way out the arm and the target stay between the side walls, thought on
            before the mouth, and the target meets no object.
        deviations: The deviations it needed, by name.
    """

    action: Action
    corridor: Corridor
    clearance: float
    withdraws_between_walls: bool
    deviations: tuple[Deviation, ...] = ()


class GraspFinder:
    """Looks for grasps of one target by one arm, at any angle and in any state. Holds nothing that changes.

    Args:
        scene: The scene, with the target.
        arm: Seen from above.
        options: For speeds, clearances and turns.
    """

    def __init__(self, scene: Scene, arm: ArmShape, options: PushingOptions) -> None:
        row = scene.target_index
        self._around = Surroundings(scene.shelf, scene.ids, scene.radii, arm.met(scene), row, arm.min_opening, options)
        self._fits = _fits(scene.shelf, arm, self._around.radius, options.neighbour_clearance)
        self._widest = arm.max_opening
        self._turns = [turn for turn in YAW_STEPS if abs(turn) <= options.max_grasp_turn + ROUNDING]

    def grasp(self, state: State, corridor: Corridor, rejects: Rejects = lambda _: None) -> Grasp | Infeasible:
        """The grasp along one corridor; see ``candidates``."""
        return self.candidates(state, [corridor], rejects)[0]

    def candidates(
        self, state: State, corridors: Sequence[Corridor], rejects: Rejects = lambda _: None
    ) -> list[Grasp | Infeasible]:
        """For each corridor the reach along its axis, the grasp and the withdrawal; or what the drive is blocked by.

        The gripper is turned by up to 15 degrees past neighbours. The link must pass free of obstacles and walls (the
        paper's success). What obstructs the yaw with the fewest obstacles is named in the result.

        Args:
            state: The world at rest.
            corridors: To the target, where it is in that state. Of each, only the angle counts.
            rejects: Tells why an action is not to be proposed again; None: it may be.
        """
        found: list[Grasp | Infeasible] = [self._too_wide] * len(corridors)
        yaws = [self._yaws(corridor.angle) for corridor in corridors]
        ends = list(accumulate(map(len, yaws)))
        # The same yaws with every fit, also of corridors that have their grasp: what is known of the arm at them is kept.
        at_once = tuple(chain.from_iterable(yaws))
        for fit in self._fits if at_once else ():
            reaches: Reaches | None = None
            for place, (least, its, end) in enumerate(zip(found, yaws, ends, strict=True)):
                if isinstance(least, Infeasible):
                    reaches = reaches or Reaches(self._around, state, fit, at_once)
                    found[place] = self._first(
                        reaches, range(end - len(its), end), corridors[place], fit, least, rejects
                    )
        return found

    def _first(
        self, reaches: Reaches, rows: range, corridor: Corridor, fit: Fit, least: Infeasible, rejects: Rejects
    ) -> Grasp | Infeasible:
        """The first reach that nothing obstructs; where there is none, what obstructs least, the last of those alike."""
        severity, best = _severity(least), -1
        for row in rows:
            its = reaches.severities[row]
            if its == FREE:
                action = reaches.action(row)
                if rejects(action) is None:
                    return self._found(reaches, row, action, corridor, fit)
                if _severity(REJECTED) <= severity:
                    severity, best, least = _severity(REJECTED), -1, REJECTED
            elif its <= severity:
                severity, best = its, row
        return least if best < 0 else reaches.obstruction(best)

    def _found(self, reaches: Reaches, row: int, action: Action, corridor: Corridor, fit: Fit) -> Grasp:
        turned = (Deviation.GRASP_TURNED,) if reaches.yaws[row] != corridor.angle else ()
        deviations = (*turned, Deviation.GRASP_TIGHT) if fit.tight else turned
        return Grasp(action, corridor, reaches.clearance(row), reaches.withdraws_between_walls(row), deviations)

    def _yaws(self, angle: float) -> list[float]:
        """The yaws tried along a corridor, in this order."""
        return [angle + turn for turn in self._turns if math.cos(angle + turn) >= LEAST_AHEAD]

    @property
    def _too_wide(self) -> Infeasible:
        wide, opens = 2.0 * self._around.radius, self._widest
        return Infeasible(f"the target is {wide:g} m wide, too wide for a gripper that opens {opens:g} m")


def grasp_action(
    scene: Scene,
    state: State,
    corridor: Corridor,
    arm: ArmShape,
    options: PushingOptions,
    rejects: Rejects = lambda _: None,
) -> Grasp | Infeasible:
    """The reach along a corridor's axis, the grasp and the withdrawal; see ``GraspFinder``, which answers more than once."""
    return GraspFinder(scene, arm, options).grasp(state, corridor, rejects)


@lru_cache(maxsize=KEPT_FITS)
def _fits(shelf: Shelf, arm: ArmShape, radius: float, clearance: float) -> tuple[Fit, ...]:
    """The fits for a target of a radius (m) that the gripper opens wide enough for, the arm kept clear of walls (m)."""
    openings = [(past, 2.0 * (radius + beside)) for past, beside in FITS]
    return tuple(
        Fit(past, opening, fit > 0, ArmView(shelf, arm.outlines(opening), clearance))
        for fit, (past, opening) in enumerate(openings)
        if opening <= arm.max_opening
    )


def _severity(obstruction: Infeasible) -> Severity:
    return not obstruction.blockers, len(obstruction.blockers)
