"""Collision checking: the context in which joint configurations are judged to be collision-free or not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phframe.core import Contacts, FloatArray, Scene, State


@dataclass(frozen=True, slots=True, eq=False)
class CollisionContext:
    """All that a verdict on a configuration depends on, besides robot and shelf; it is handed to every question.

    Attributes:
        state: Where the objects are.
        opening: Distance between the fingers (m).
        allowed: Ids of the objects that the robot may touch.
        start: Joint values ``(dof,)`` where a motion begins: what touches there may touch, no deeper, all along, since
            the robot must get away from it. None: nothing may.
    """

    state: State
    opening: float
    allowed: frozenset[str] = frozenset()
    start: FloatArray | None = None

    def obstacles(self, scene: Scene) -> FloatArray:
        """Upright cylinders ``(m, 4)`` around what must not be touched: x, y, radius and top (m), in the shelf frame."""
        radii = np.where(self.state.on_board, scene.radii, -np.inf)
        tops = self.state.poses[:, 2] + np.array([item.shape.height for item in scene.objects]) / 2.0
        forbidden = [item.id not in self.allowed for item in scene.objects]
        return np.column_stack([self.state.positions, radii, tops])[forbidden]


def allowed_objects(contacts: Contacts, scene: Scene, manipuland: str | None) -> frozenset[str]:
    """Ids of the objects that may be touched where a path's rule says so; the manipuland is what the path handles."""
    match contacts:
        case Contacts.OBJECTS:
            return frozenset(scene.ids)
        case Contacts.MANIPULAND if manipuland is not None:
            return frozenset({manipuland})
        case _:
            return frozenset()
