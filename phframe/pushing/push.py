"""Gripper paths for sweeps."""

from __future__ import annotations

import numpy as np

from phframe.core import Action, Contacts, Corridor, GripperPath, Phase, PhaseRule, Sweep
from phframe.pushing.options import PushingOptions


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
