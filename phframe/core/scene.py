"""A shelf, the objects on it, and which one is wanted. Immutable; everything stands in the shelf frame.

Shelf frame: x is the depth from the mouth plane (0) to the back wall, y = 0 at the south wall and ``width`` at the
north wall, z up from the board. Metres, radians, seconds, kilograms.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from phframe.core.errors import SceneError
from phframe.core.pose import planar_pose
from phframe.core.scene_check import problems_of
from phframe.core.shape import Cylinder
from phframe.core.state import Condition, State
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


@dataclass(frozen=True, slots=True)
class Scene:
    """A shelf, its objects and the target.

    Attributes:
        name: What the scene is called, such as ``vieira/basic``.
        shelf: The shelf.
        objects: All objects, the target among them. Their order is the order of every array of poses.
        target: The id of the object to take out.
        base_poses: Where an arm's base stands, by the arm's name; an arm that is not named uses its own default.

    Raises:
        SceneError: If a figure is not finite or not positive, ids repeat, the target is missing, or objects overlap or
            stand outside the shelf. It names every problem, with the amounts.
    """

    name: str
    shelf: Shelf
    objects: tuple[SceneObject, ...]
    target: str
    base_poses: Mapping[str, BasePose] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        problems = problems_of(self)
        if problems:
            raise SceneError(problems, self.name)

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all objects, in order."""
        return tuple(o.id for o in self.objects)

    @property
    def target_index(self) -> int:
        """Row of the target in every array of poses."""
        return self.index(self.target)

    @property
    def radii(self) -> FloatArray:
        """Bounding radii ``(n,)`` of all objects (m)."""
        return np.array([o.radius for o in self.objects])

    def index(self, object_id: str) -> int:
        """Row of an object in every array of poses.

        Raises:
            SceneError: If there is no such object.
        """
        try:
            return self.ids.index(object_id)
        except ValueError:
            raise SceneError(f"no object {object_id!r}; there is: {', '.join(self.ids)}", self.name) from None

    def initial_state(self) -> State:
        """The scene as written: every object upright at its position, the arm parked."""
        poses = [planar_pose(*o.position, o.shape.height / 2.0, o.yaw) for o in self.objects]
        return State(np.array(poses), (Condition.UPRIGHT,) * len(self.objects))


def coulomb_with_board(scene: Scene, item: SceneObject) -> float:
    """The coefficient of friction between an object and the board."""
    return scene.shelf.board_friction if item.friction is None else item.friction
