"""Steered legs as actions: what is carried out holds the same twists one after another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import (
    Action,
    ActionKind,
    ArmShape,
    Contacts,
    FloatArray,
    GripperPath,
    Phase,
    PhaseRule,
    controlled_path,
)
from phframe.kinodynamic.paths import at_rest, joined, straight_back
from phframe.kinodynamic.steered_tree import Controls
from phframe.kinodynamic.steerer import SteeredLeg


def steered_push(
    legs: Sequence[SteeredLeg], controls: Controls, arm: ArmShape, moves: str, back_off: float
) -> Action | None:
    """An approach, a push and a short way straight back, fingers closed; None where no leg moves the arm.

    Args:
        legs: The approach, and the push that goes on from it, where there is one.
        controls: For the length of a step, and the speed of the way back.
        arm: Seen from above.
        moves: Id of the object.
        back_off: How long the arm backs off afterwards (s).
    """
    rule = PhaseRule(controls.speed, arm.min_opening, Contacts.OBJECTS)
    paths = _steered(legs, (Phase.INSERT, Phase.SWEEP), rule, controls)
    if not paths:
        return None
    distance = back_off * controls.speed
    back = [straight_back(paths[-1].poses[-1], distance, Phase.RETREAT, rule)] if distance > 0.0 else []
    return Action(f"steer {moves} aside", joined([*paths, *back]), (moves,))


def steered_reach(
    leg: SteeredLeg, controls: Controls, opening: float, closed: float, target: str, out: float
) -> Action:
    """A steered reach with open fingers, which then close and draw the target straight out.

    Args:
        leg: The reach.
        controls: For the length of a step.
        opening: Distance between the open fingers (m).
        closed: Between the closed ones (m).
        target: Id of the object.
        out: How far before the mouth its centre is drawn (m).
    """
    reach = PhaseRule(controls.speed, opening, Contacts.OBJECTS)
    grasp = PhaseRule(controls.speed, closed, Contacts.OBJECTS)
    paths = _steered([leg], (Phase.REACH,), reach, controls) or [at_rest(leg.start, Phase.REACH, reach)]
    end = paths[-1].poses[-1]
    distance = (float(end[0]) + out) / float(np.cos(end[2]))
    paths += [at_rest(end, Phase.GRASP, grasp), straight_back(end, distance, Phase.WITHDRAW, grasp)]
    return Action(f"grasp {target}", joined(paths, target), (target,), ActionKind.GRASP)


def _steered(
    legs: Sequence[SteeredLeg], phases: Sequence[Phase], rule: PhaseRule, controls: Controls
) -> list[GripperPath]:
    """The paths of the legs that move the arm, each from where the one before ends: what is driven, not where it got."""
    paths: list[GripperPath] = []
    for leg, phase in zip(legs, phases, strict=False):
        start: FloatArray = paths[-1].poses[-1] if paths else leg.start
        if len(leg.twists):
            paths.append(controlled_path(start, leg.twists, controls.step, phase, rule))
    return paths
