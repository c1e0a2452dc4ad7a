"""Gives objects their friction with the board just before anything can touch them.

What nothing has touched lies still with or without its friction, bit for bit, but its joints are most of what a step
costs. So an object gets them when something that may move is about to reach it, and keeps them.
"""

from __future__ import annotations

import math

from phframe.backends.pymunk_.world import ShelfItem, ShelfSpace, lay_floor

AHEAD = 8
"""What can be reached within so many steps gets its friction now."""
HASTE, SLACK = 2.0, 0.05
"""What is pushed goes at most so many times as fast as the arm, and so much faster (m/s)."""

Circle = tuple[float, float, float]
"""Centre and bounding radius of an object (m)."""


class Lookout:
    """Watches, during one run, for what the arm, or anything that it pushes, may touch.

    Args:
        world: Where.
        step: Time step (s).

    Attributes:
        due: The step before which it has to look again.
    """

    def __init__(self, world: ShelfSpace, step: float) -> None:
        self._world, self._step = world, step
        self.expect(0.0)

    def expect(self, speed: float) -> None:
        """Reckon, from now on, with an arm of this speed (m/s)."""
        self._speed, self.due = speed, 0.0

    def look(self) -> None:
        """Lay the floor under what may be touched within some steps."""
        fastest, movers, waiting = self._speed, [], []
        for item in self._world.items.values():
            x, y = item.body.position
            if item.floor:
                movers.append((x, y, item.radius))
                fastest = max(fastest, math.hypot(*item.body.velocity))
            else:
                waiting.append((item, (x, y, item.radius)))
        reach = (HASTE * fastest + SLACK) * self._step
        self.due = self._world.tick + lay_floors(self._world, waiting, movers, AHEAD * reach) / reach


def lay_floors(world: ShelfSpace, waiting: list[tuple[ShelfItem, Circle]], movers: list[Circle], near: float) -> float:
    """Lay the floor under what is near the arm, or near something that may be pushed, and so on.

    Args:
        world: Where.
        waiting: What has no floor yet.
        movers: What may be pushed.
        near: How near (m).

    Returns:
        Distance (m) from the arm and all that may be pushed to the nearest object that still has no floor.
    """
    gaps = _gaps_to_arm(world, [circle for _, circle in waiting])
    while waiting:
        gaps = [_nearest(gap, circle, movers) for gap, (_, circle) in zip(gaps, waiting, strict=True)]
        if min(gaps) >= near:
            return min(gaps)
        reached = [one for gap, one in zip(gaps, waiting, strict=True) if gap < near]
        waiting = [one for gap, one in zip(gaps, waiting, strict=True) if gap >= near]
        gaps = [gap for gap in gaps if gap >= near]
        movers = [circle for _, circle in reached]
        for item, _ in reached:
            lay_floor(world, item)
    return math.inf


def _gaps_to_arm(world: ShelfSpace, circles: list[Circle]) -> list[float]:
    """Distance of each circle from the box around the arm (m), below 0 where they overlap."""
    (x0, y0), angle = world.arm.body.position, world.arm.body.angle
    c, s = math.cos(angle), math.sin(angle)
    left, bottom, right, top = world.measures.hull
    gaps = []
    for x, y, radius in circles:
        along, across = c * (x - x0) + s * (y - y0), c * (y - y0) - s * (x - x0)
        gaps.append(math.hypot(max(left - along, along - right, 0.0), max(bottom - across, across - top, 0.0)) - radius)
    return gaps


def _nearest(gap: float, circle: Circle, others: list[Circle]) -> float:
    """The least of a distance and those between a circle and others (m)."""
    x, y, radius = circle
    for x1, y1, radius1 in others:
        between = math.hypot(x - x1, y - y1) - radius - radius1
        if between < gap:
            gap = between
    return gap
