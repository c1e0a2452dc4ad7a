"""Gripper paths made of steered motions and straight ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import ArmShape, FloatArray, GripperPath, Phase, PhaseRule
from phframe.core.gripper_path import LEAST_AHEAD, MOUTH_CLEARANCE


def joined(paths: Sequence[GripperPath], manipuland: str | None = None) -> GripperPath:
    """Paths one after another, each from where the one before ends; the rule of every leg is kept.

    Args:
        paths: At least one.
        manipuland: What the whole handles.
    """
    poses = np.vstack([paths[0].poses, *(path.poses[1:] for path in paths[1:])])
    phases = [phase for path in paths for phase in path.phases]
    every = [path.rule(leg) for path in paths for leg in range(len(path.phases))]
    rules = dict(zip(phases, every, strict=True))
    own = {leg: rule for leg, rule in enumerate(every) if rule != rules[phases[leg]]}
    return GripperPath(poses, tuple(phases), rules, manipuland, own)


def straight_back(pose: FloatArray, distance: float, phase: Phase, rule: PhaseRule) -> GripperPath:
    """Straight back along the arm's axis, where the arm has made room for itself.

    Args:
        pose: Of the fingertip ``(3,)``.
        distance: How far (m), above 0.
        phase: Of the leg.
        rule: Of the leg.
    """
    ahead = np.array([np.cos(pose[2]), np.sin(pose[2]), 0.0])
    return GripperPath(np.array([pose, pose - distance * ahead]), (phase,), {phase: rule})


def at_rest(pose: FloatArray, phase: Phase, rule: PhaseRule) -> GripperPath:
    """A leg in which the fingers move and nothing else does."""
    return GripperPath(np.array([pose, pose]), (phase,), {phase: rule})


def way_out(pose: FloatArray, arm: ArmShape) -> float:
    """How far straight back it is until all of an arm is well before the mouth (m); 0: it is there.

    Args:
        pose: Of the fingertip ``(3,)``.
        arm: With its fingers closed.
    """
    yaw = float(pose[2])
    return max(0.0, float(pose[0]) + arm.front(yaw) + MOUTH_CLEARANCE) / max(float(np.cos(yaw)), LEAST_AHEAD)
