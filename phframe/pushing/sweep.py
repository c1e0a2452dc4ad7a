"""A sweep (Algorithm 3) in numbers, and as an action."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from phframe.core import Action, Contacts, FloatArray, GripperPath, Phase, PhaseRule
from phframe.pushing.corridor import Corridor
from phframe.pushing.options import PushingOptions


@dataclass(frozen=True, slots=True)
class Sweep:
    """A pushing action in numbers (Algorithm 3), in the corridor frame.

    Attributes:
        direction: +1 bottom to top (towards the north), -1 top to bottom.
        depth: x at which the fingertip sweeps (m).
        lane: y at which it begins to (m).
        end: y at which it ends (m).
        entry: How far the arm goes straight in before it sweeps (m).
        exit: How far it draws straight out afterwards (m).
        tilt: Of the arm against the corridor (rad); the paper's sweeps have none.
    """

    direction: Literal[1, -1]
    depth: float
    lane: float
    end: float
    entry: float
    exit: float
    tilt: float = 0.0

    @property
    def waypoints(self) -> FloatArray:
        """``(4, 2)`` fingertip positions: before the mouth, inserted, swept, out (m)."""
        ahead = np.array([math.cos(self.tilt), math.sin(self.tilt)])
        inserted, swept = np.array([self.depth, self.lane]), np.array([self.depth, self.end])
        return np.array([inserted - self.entry * ahead, inserted, swept, swept - self.exit * ahead])


def push_action(
    corridor: Corridor, sweep: Sweep, moves: tuple[str, ...], closed: float, options: PushingOptions
) -> Action:
    """A sweep as an action in the shelf frame: in, across, straight out, fingers closed, at one yaw.

    Args:
        corridor: In whose frame the sweep is given.
        sweep: The sweep.
        moves: Ids of the objects it means to move.
        closed: Distance between the closed fingers (m).
        options: For the speeds.
    """
    positions = corridor.to_shelf(sweep.waypoints)
    poses = np.column_stack([positions, np.full(len(positions), corridor.angle + sweep.tilt)])
    insert = PhaseRule(options.insert_speed, closed, Contacts.OBJECTS)
    rules = {
        Phase.INSERT: insert,
        Phase.SWEEP: PhaseRule(options.sweep_speed, closed, Contacts.OBJECTS),
        Phase.RETREAT: insert,
    }
    path = GripperPath(poses, (Phase.INSERT, Phase.SWEEP, Phase.RETREAT), rules)
    return Action(f"sweep {'north' if sweep.direction == 1 else 'south'}: {', '.join(moves)}", path, moves)
