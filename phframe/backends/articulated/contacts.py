"""What the arm touches, and which object its fingers hold between them, read from the engine's contacts."""

from __future__ import annotations

import math
from collections.abc import Sequence

from phframe.backends.articulated.engine import ContactPair, EngineContact, Vector
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
        self._known: set[ContactPair] = set()
        self._count, self._read_at, self._told = 0.0, 0.0, 0
        self._last_grip = self._held_at = 0.0

    def look(self, time: float, count: float) -> None:
        """Write down what the arm touches at a time (s), which has so many contacts."""
        read = count > self._count or (count and time - self._read_at >= REREAD)
        world = self._world
        grip = time - self._held_at >= REREAD and (world.held is not None or (count and world.squeeze > SQUEEZE))
        self._count = count
        if read or grip:
            contacts = list(world.engine.contacts())
            if read:
                self._read(time, contacts)
            if grip:
                self._hold(time, _gripped(contacts))

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

    def _read(self, time: float, contacts: Sequence[EngineContact]) -> None:
        """Note what a part of the arm touches for the first time in this phase."""
        self._read_at, known = time, self._known
        for pair, _ in contacts:
            if pair not in known:
                known.add(pair)
                self.found.append((time, pair.part, pair.body, pair.wall))

    def _hold(self, time: float, gripped: int | None) -> None:
        """An object is held from when it is squeezed until it has been out of the fingers' grip for a while."""
        world, self._held_at = self._world, time
        if gripped is not None:
            self._last_grip = time
            if world.held != gripped:
                world.hold(gripped)
        elif world.held is not None and time - self._last_grip > LOST:
            world.hold(None)


def _gripped(contacts: Sequence[EngineContact]) -> int | None:
    """Row of the object that both fingers press from opposite sides, if there is one."""
    pushes: dict[int, dict[int, Vector]] = {}
    for (_, _, _, row, finger), (x, y, z) in contacts:
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
