"""Segments of a motion, from rest to rest: straight lines in joint space, and the legs of a Cartesian path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from phframe.core import FloatArray, GripperPath, Phase, PhaseRule
from phframe.motion.cartesian_path import JointPath

JOINT_STEP = 0.05
"""Most that a joint moves between two samples of a straight line in joint space (rad or m)."""


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """Joints from rest to rest.

    Attributes:
        joints: ``(k, dof)``.
        openings: Distance between the fingers meanwhile ``(k,)`` (m).
        phase: What the arm is doing.
        rule: How fast the gripper may be; None: as fast as the joints.
        poses: What the joints stand for ``(k, 3)``: x, y, yaw; None: nothing that is level in the gripper plane.
    """

    joints: FloatArray
    openings: FloatArray
    phase: Phase
    rule: PhaseRule | None = None
    poses: FloatArray | None = None


def straight_segments(corners: FloatArray, opening: float, end_opening: float) -> Iterator[Segment]:
    """Straight from corner to corner ``(k, dof)`` of the joints; the fingers move all the way."""
    openings = np.linspace(opening, end_opening, len(corners))
    for (begin, end), (first, last) in zip(pairwise(corners), pairwise(openings), strict=True):
        steps = max(2, int(np.ceil(np.abs(end - begin).max() / JOINT_STEP)) + 1)
        fraction = np.linspace(0.0, 1.0, steps)
        yield Segment(begin + fraction[:, None] * (end - begin), first + fraction * (last - first), Phase.APPROACH)


def leg_segments(joint_path: JointPath, path: GripperPath, opening: float) -> Iterator[Segment]:
    """The legs of a path in joint space; at the end of each the fingers are as its rule has them."""
    begin = 0
    for leg in dict.fromkeys(joint_path.legs.tolist()):
        end = int(np.flatnonzero(joint_path.legs == leg)[-1])
        rule = path.rule(leg)
        rows = slice(begin, end + 1)
        openings = np.linspace(opening, rule.opening, end + 1 - begin)
        if end > begin:
            yield Segment(joint_path.joints[rows], openings, path.phases[leg], rule, joint_path.poses[rows])
        begin, opening = end, rule.opening
