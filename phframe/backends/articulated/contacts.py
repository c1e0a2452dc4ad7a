"""What the arm touches, and which object its fingers hold between them, read from the engine's contacts."""

from __future__ import annotations

import math

from phframe.backends.articulated.engine import Vector
from phframe.backends.articulated.world import ArticulatedWorld
from phframe.backends.contract import Touch

OPPOSED = -0.7
"""Two fingers hold what they press from opposite sides: the cosine between their pushes is below this."""
SQUEEZE = 1e-3
"""Fingers that are told to be this much closer (m) than they are, squeeze."""
REREAD = 0.02
"""As long as there are no more contacts than before, they are read this often (s), and so is what the fingers press."""
LOST = 0.1
"""What the fingers have not pressed for this long (s) is no longer held."""


class TouchLog:
    """What the arm has touched since a motion began.

    Args:
        world: Whose contacts are read.
    """

    def __init__(self, world: ArticulatedWorld) -> None:
        self._world = world
        self.found: list[Touch] = []
        self._known: set[tuple[str, str, bool]] = set()
        self._count, self._read_at, self._told = 0.0, 0.0, 0
        self._last_grip = self._held_at = 0.0

    def look(self, time: float, count: float) -> None:
        """Write down what the arm touches at a time (s), which has so many contacts."""
        if count > self._count or (count and time - self._read_at >= REREAD):
            self._read(time)
        self._count = count
        if time - self._held_at >= REREAD and (self._world.held is not None or (count and self._squeezing)):
            self._held_at = time
            self._hold(time)

    def forget_phase(self) -> None:
        """Write down again what is touched already, as a new phase begins."""
        self._known, self._count = set(), 0.0

    @property
    def any_news(self) -> bool:
        """Whether anything was found since ``news`` was last asked."""
        return len(self.found) > self._told

    def news(self) -> list[Touch]:
        """What was found since this was last asked."""
        told, self._told = self._told, len(self.found)
        return self.found[told:]

    @property
    def _squeezing(self) -> bool:
        return self._world.squeeze > SQUEEZE

    def _read(self, time: float) -> None:
        """Note what a part of the arm touches for the first time in this phase."""
        self._read_at = time
        for part, body, wall, *_ in self._world.engine.contacts():
            if (part, body, wall) not in self._known:
                self._known.add((part, body, wall))
                self.found.append((time, part, body, wall))

    def _hold(self, time: float) -> None:
        """An object is held from when it is squeezed until it has been out of the fingers' grip for a while."""
        world, gripped = self._world, self._gripped()
        if gripped is not None:
            self._last_grip = time
            if world.held != gripped:
                world.hold(gripped)
        elif world.held is not None and time - self._last_grip > LOST:
            world.hold(None)

    def _gripped(self) -> int | None:
        """Row of the object that both fingers press from opposite sides, if there is one."""
        pushes: dict[int, dict[int, Vector]] = {}
        for _, _, _, row, finger, (x, y, z) in self._world.engine.contacts():
            if row is not None and finger:
                fingers = pushes.setdefault(row, {})
                fx, fy, fz = fingers.get(finger, (0.0, 0.0, 0.0))
                fingers[finger] = fx + x, fy + y, fz + z
        held = (row for row, fingers in pushes.items() if len(fingers) == 2 and _opposed(*fingers.values()))
        return next(held, None)


def _opposed(one: Vector, other: Vector) -> bool:
    """Whether the cosine between two pushes, a . b / |a| |b|, is that of fingers which press towards one another."""
    across = one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
    return across < OPPOSED * math.hypot(*one) * math.hypot(*other)
