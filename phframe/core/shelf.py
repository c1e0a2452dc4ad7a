"""What scenes are made of: a shelf, objects at rest on its board, and where an arm's base stands."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core.pose import planar_pose
from phframe.core.shape import Cylinder
from phframe.core.value import FloatArray

BOARD_FRICTION = 0.25
WALL_FRICTION = 0.2

AnyShape = Cylinder
"""The shapes that objects of a scene may have, as files know them: one, and more to come."""


@dataclass(frozen=True, slots=True)
class Shelf:
    """The inside of a shelf that is open at the mouth: board, two side walls, back wall, ceiling.

    Attributes:
        depth: Mouth plane to back wall (m).
        width: South wall to north wall (m).
        height: Board to ceiling (m).
        board_friction: Coulomb coefficient between board and objects, unless an object has its own.
        wall_friction: Coulomb coefficient between walls and objects.
    """

    depth: float
    width: float
    height: float = 0.4
    board_friction: float = BOARD_FRICTION
    wall_friction: float = WALL_FRICTION


@dataclass(frozen=True, slots=True)
class SceneObject:
    """One object at rest on the board.

    Attributes:
        id: Unique name.
        shape: Its geometry; the origin is at the centre.
        position: Centre (x, y) in the shelf frame (m).
        yaw: Heading (rad).
        mass: Kilograms.
        friction: Coulomb coefficient with the board; None takes the shelf's.
    """

    id: str
    shape: AnyShape
    position: tuple[float, float]
    yaw: float = 0.0
    mass: float = 0.3
    friction: float | None = None

    @property
    def radius(self) -> float:
        """Bounding radius seen from above (m)."""
        return self.shape.bounding_radius


@dataclass(frozen=True, slots=True)
class BasePose:
    """Where an arm's base stands: position (m) and yaw (rad) in the shelf frame."""

    x: float
    y: float
    z: float
    yaw: float

    @property
    def pose(self) -> FloatArray:
        """The base's pose ``(7,)`` in the shelf frame."""
        return planar_pose(self.x, self.y, self.z, self.yaw)
