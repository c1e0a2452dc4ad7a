"""Gives objects their friction with the board just before anything can touch them.

What nothing has touched lies still with or without its friction, bit for bit, but its joints are most of what a step
costs. So an object gets them when something that may move is about to reach it, and keeps them.
"""

from __future__ import annotations

import math

from phframe.backends.pymunk_.world import ShelfSpace, lay_floor

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
        world = self._world
        movable = world.movable
        if len(movable) == len(world.items):
            self.due = math.inf
            return
        fastest = max([self._speed, *(math.hypot(*item.body.velocity) for item in movable)])
        self.due = world.tick + lay_floors(world, (HASTE * fastest + SLACK) * self._step)


def lay_floors(world: ShelfSpace, reach: float) -> float:
    """Lay the floor under what may be touched within some steps.

    Args:
        world: Where.
        reach: How far anything goes in a step at most (m).

    Returns:
        For how many steps nothing else can be touched.
    """
    circles = {name: (*item.body.position, item.radius) for name, item in world.items.items()}
    movers = {item.name: circles[item.name] for item in world.movable}
    gaps = _gaps_to_arm(world, {name: circle for name, circle in circles.items() if name not in movers})
    while gaps:
        _narrow(gaps, circles, movers)
        reached = [name for name, gap in gaps.items() if gap < AHEAD * reach]
        if not reached:
            return min(gaps.values()) / reach
        for name in reached:
            lay_floor(world, world.items[name])
            del gaps[name]
        movers = {name: circles[name] for name in reached}
    return math.inf


def _gaps_to_arm(world: ShelfSpace, circles: dict[str, Circle]) -> dict[str, float]:
    """Distance of each circle from the box around the arm (m), below 0 inside."""
    (x0, y0), angle = world.arm.body.position, world.arm.body.angle
    c, s = math.cos(angle), math.sin(angle)
    left, bottom, right, top = world.measures.hull
    gaps = {}
    for name, (x, y, radius) in circles.items():
        along, across = c * (x - x0) + s * (y - y0), c * (y - y0) - s * (x - x0)
        gaps[name] = math.hypot(max(left - along, along - right, 0.0), max(bottom - across, across - top, 0.0)) - radius
    return gaps


def _narrow(gaps: dict[str, float], circles: dict[str, Circle], movers: dict[str, Circle]) -> None:
    """Take in the distances from what else may move."""
    for name in gaps:
        x, y, radius = circles[name]
        for x1, y1, radius1 in movers.values():
            gap = math.hypot(x - x1, y - y1) - radius - radius1
            if gap < gaps[name]:
                gaps[name] = gap
