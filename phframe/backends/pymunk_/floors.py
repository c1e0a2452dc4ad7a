"""Gives objects their friction with the board just before anything can touch them.

What nothing has touched lies still with or without its friction, bit for bit, but its joints are most of what a step
costs. So an object gets them when something that may move is about to reach it, and keeps them.
"""

from __future__ import annotations

import math

from phframe.backends.pymunk_.world import ShelfItem, ShelfSpace, lay_floor

AHEAD = 4
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
        speeds = [math.hypot(*item.body.velocity) for item in world.items.values() if item.floor]
        reach = (HASTE * max([self._speed, *speeds]) + SLACK) * self._step
        self.due = world.tick + lay_floors(world, reach)


def lay_floors(world: ShelfSpace, reach: float) -> float:
    """Lay the floor under what may be touched within some steps.

    Args:
        world: Where.
        reach: How far anything goes in a step at most (m).

    Returns:
        For how many steps nothing else can be touched.
    """
    items = world.items
    circles = {name: _circle(item) for name, item in items.items()}
    gaps = _gaps_to_arm(world, {name: circle for name, circle in circles.items() if not items[name].floor})
    movable = [circle for name, circle in circles.items() if name not in gaps]
    while gaps:
        _narrow(gaps, circles, movable)
        reached = [name for name, gap in gaps.items() if gap < AHEAD * reach]
        if not reached:
            return min(gaps.values()) / reach
        for name in reached:
            lay_floor(world, items[name])
            del gaps[name]
        movable = [circles[name] for name in reached]
    return math.inf


def _circle(item: ShelfItem) -> Circle:
    x, y = item.body.position
    return x, y, item.radius


def _gaps_to_arm(world: ShelfSpace, circles: dict[str, Circle]) -> dict[str, float]:
    """Distance of each circle from the box around the arm (m), below 0 inside."""
    (x0, y0), angle = world.arm.body.position, world.arm.body.angle
    c, s = math.cos(angle), math.sin(angle)
    left, bottom, right, top = world.measures.hull
    gaps = {}
    for name, (x, y, radius) in circles.items():
        along, across = c * (x - x0) + s * (y - y0), c * (y - y0) - s * (x - x0)
        beside = max(left - along, along - right, 0.0), max(bottom - across, across - top, 0.0)
        gaps[name] = math.hypot(*beside) - radius
    return gaps


def _narrow(gaps: dict[str, float], circles: dict[str, Circle], movable: list[Circle]) -> None:
    """Take in the distances from what may be moved."""
    for name, gap in gaps.items():
        x, y, radius = circles[name]
        for x1, y1, radius1 in movable:
            gap = min(gap, math.hypot(x - x1, y - y1) - radius - radius1)
        gaps[name] = gap
