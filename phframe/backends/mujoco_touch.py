"""What the arm touches, and what its fingers hold between them: read from MuJoCo's contacts."""

from __future__ import annotations

import numpy as np

from phframe.backends.mujoco_model import Model
from phframe.backends.mujoco_world import World, hold
from phframe.core import FloatArray, IntArray

OPPOSED = -0.7
"""Two fingers hold what they press from opposite sides: the cosine between their pushes is below this."""
SQUEEZE = 1e-3
"""Fingers that are told to be this much closer (m) than they are, squeeze."""
LOST = 0.1
"""What the fingers have not pressed for this long (s) is no longer held."""

Touch = tuple[float, str, str, bool]
"""Time (s), part of the arm, what it met, whether that is a wall."""


class Touches:
    """What the arm has touched since a motion began.

    Args:
        world: Whose contacts are read.
    """

    def __init__(self, world: World) -> None:
        self._world, self._model = world, world.model
        self.found: list[Touch] = []
        self._pairs = b""
        self._last_grip = 0.0
        self._gripped: int | None = world.held

    def look(self, time: float, touching: bool) -> None:
        """Write down what the arm touches at a time (s)."""
        if touching:
            self._read(time)
        else:
            self._pairs, self._gripped = b"", None
        self._hold(time)

    def forget_phase(self) -> None:
        """Write down again what is touched already, as a new phase begins."""
        self._pairs = b""

    def _read(self, time: float) -> None:
        contact = self._world.data.contact
        geoms = contact.geom
        arm = self._model.is_arm[geoms]
        rows = np.flatnonzero(arm[:, 0] != arm[:, 1])
        pairs = geoms[rows].tobytes()
        if pairs == self._pairs:
            return
        self._pairs = pairs
        own = np.where(arm[rows, 0], geoms[rows, 0], geoms[rows, 1])
        other = np.where(arm[rows, 0], geoms[rows, 1], geoms[rows, 0])
        self.found += self._new(time, own, other)
        signs = np.where(arm[rows, 0], 1.0, -1.0)
        self._gripped = self._between(own, other, contact.frame[rows, :3] * signs[:, None])

    def _new(self, time: float, own: IntArray, other: IntArray) -> list[Touch]:
        names, walls = self._model.names, self._model.is_wall
        pairs = dict.fromkeys(zip(own.tolist(), other.tolist(), strict=True))
        return [(time, names[part], names[what], bool(walls[what])) for part, what in pairs]

    def _between(self, own: IntArray, other: IntArray, pushes: FloatArray) -> int | None:
        """Row of the object that both fingers press from opposite sides, if there is one."""
        side = self._model.sides[own]
        for geom in np.intersect1d(other[side == 1], other[side == -1]):
            left, right = (_mean(pushes[(other == geom) & (side == way)]) for way in (1, -1))
            if float(left @ right) < OPPOSED:
                return _object_row(self._model, int(geom))
        return None

    def _hold(self, time: float) -> None:
        """An object is held from when it is squeezed until it has been out of the fingers' grip for a while."""
        world = self._world
        if self._gripped is not None and (world.held == self._gripped or world.opening - world.command > SQUEEZE):
            self._last_grip = time
            if world.held != self._gripped:
                hold(world, self._gripped)
        elif world.held is not None and time - self._last_grip > LOST:
            hold(world, None)


def _mean(directions: FloatArray) -> FloatArray:
    total = directions.sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _object_row(model: Model, geom: int) -> int | None:
    body = int(model.mj.geom_bodyid[geom])
    rows = np.flatnonzero(model.bodies == body)
    return int(rows[0]) if len(rows) else None
