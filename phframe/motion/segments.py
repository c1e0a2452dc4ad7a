"""Parts of a motion that begin and end at rest: free ways from corner to corner, and the legs of a path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from phframe.core import FloatArray, GripperPath, Phase, PhaseRule
from phframe.motion.route import Route

JOINT_STEP = 0.05
"""Between the values of a joint on a free way (rad or m)."""


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
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


def free_way(corners: FloatArray, opening: float, end_opening: float) -> Iterator[Stretch]:
    """Straight from corner to corner ``(k, dof)`` of the joints; the fingers move all the way."""
    openings = np.linspace(opening, end_opening, len(corners))
    for (begin, end), (first, last) in zip(pairwise(corners), pairwise(openings), strict=True):
        steps = max(2, int(np.ceil(np.abs(end - begin).max() / JOINT_STEP)) + 1)
        fraction = np.linspace(0.0, 1.0, steps)
        yield Stretch(begin + fraction[:, None] * (end - begin), first + fraction * (last - first), Phase.APPROACH)


def legs_of(route: Route, path: GripperPath, opening: float) -> Iterator[Stretch]:
    """The legs of a route; at the end of each the fingers are as its rule has them."""
    begin = 0
    for leg in dict.fromkeys(route.legs.tolist()):
        end = int(np.flatnonzero(route.legs == leg)[-1])
        rule = path.rule(leg)
        rows = slice(begin, end + 1)
        openings = np.linspace(opening, rule.opening, end + 1 - begin)
        if end > begin:
            yield Stretch(route.joints[rows], openings, path.phases[leg], rule, route.poses[rows])
        begin, opening = end, rule.opening
