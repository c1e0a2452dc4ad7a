"""What the arm touches, and what its fingers hold between them: read from MuJoCo's contacts."""

from __future__ import annotations

import math

from phframe.backends.mujoco_world import World, hold

OPPOSED = -0.7
"""Two fingers hold what they press from opposite sides: the cosine between their pushes is below this."""
SQUEEZE = 1e-3
"""Fingers that are told to be this much closer (m) than they are, squeeze."""
REREAD = 0.02
"""As long as there are no more contacts than before, they are read this often (s), and so is what the fingers press."""
LOST = 0.1
"""What the fingers have not pressed for this long (s) is no longer held."""

Touch = tuple[float, str, str, bool]
"""Time (s), part of the arm, what it met, whether that is a wall."""
Vector = tuple[float, float, float]


class Touches:
    """What the arm has touched since a motion began.

    Args:
        world: Whose contacts are read.
    """

    def __init__(self, world: World) -> None:
        self._world, self._model = world, world.model
        self.found: list[Touch] = []
        self._known: set[tuple[int, int]] = set()
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
        return self._world.opening - self._world.command > SQUEEZE

    def _read(self, time: float) -> None:
        """Note what a part of the arm touches for the first time in this phase."""
        self._read_at = time
        arm, names, walls = self._model.is_arm, self._model.names, self._model.is_wall
        for one, other in self._world.data.contact.geom.tolist():
            if arm[one] is arm[other]:
                continue
            pair = (one, other) if arm[one] else (other, one)
            if pair not in self._known:
                self._known.add(pair)
                self.found.append((time, names[pair[0]], names[pair[1]], walls[pair[1]]))

    def _hold(self, time: float) -> None:
        """An object is held from when it is squeezed until it has been out of the fingers' grip for a while."""
        world, gripped = self._world, self._gripped()
        if gripped is not None:
            self._last_grip = time
            if world.held != gripped:
                hold(world, gripped)
        elif world.held is not None and time - self._last_grip > LOST:
            hold(world, None)

    def _gripped(self) -> int | None:
        """Row of the object that both fingers press from opposite sides, if there is one."""
        contact, sides, rows = self._world.data.contact, self._model.sides, self._model.rows
        pushes: dict[int, dict[int, Vector]] = {}
        for (one, other), (x, y, z) in zip(contact.geom.tolist(), contact.frame[:, :3].tolist(), strict=True):
            side, row = sides[one] or sides[other], rows[other] if sides[one] else rows[one]
            if side and row is not None:
                sign, fingers = (1.0 if sides[one] else -1.0), pushes.setdefault(row, {})
                fx, fy, fz = fingers.get(side, (0.0, 0.0, 0.0))
                fingers[side] = fx + sign * x, fy + sign * y, fz + sign * z
        held = (row for row, fingers in pushes.items() if len(fingers) == 2 and _opposed(*fingers.values()))
        return next(held, None)


def _opposed(one: Vector, other: Vector) -> bool:
    across = one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
    return across < OPPOSED * math.hypot(*one) * math.hypot(*other)
