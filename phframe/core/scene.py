"""A shelf, the objects on it, and which one is wanted. Immutable; everything stands in the shelf frame.

Shelf frame: x is the depth from the mouth plane (0) to the back wall, y = 0 at the south wall and ``width`` at the
north wall, z up from the board. Metres, radians, seconds, kilograms.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from phframe.core.errors import SceneError
from phframe.core.names import name_fault, name_shown
from phframe.core.pose import planar_pose
from phframe.core.scene_check import problems_of
from phframe.core.shelf import BasePose, SceneObject, Shelf
from phframe.core.state import Condition, State
from phframe.core.value import FloatArray, short_repr


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
        SceneError: If a figure is not finite, not positive or beyond what engines bear, a name is no printable line, ids
            repeat, the target is missing, or objects overlap or stand outside the shelf. It names the first ten problems,
            with the amounts.
    """

    name: str
    shelf: Shelf
    objects: tuple[SceneObject, ...]
    target: str
    base_poses: Mapping[str, BasePose] = field(default_factory=dict, hash=False)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        problems = problems_of(self.name, self.shelf, self.objects, self.target, self.base_poses)
        if problems:
            raise SceneError(problems, name_shown(self.name) if name_fault(self.name) else self.name)

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

    @property
    def coverage(self) -> float:
        """The part of the board that the objects cover: the area of their outlines over the board's, 0 to 1."""
        return sum(o.shape.area for o in self.objects) / (self.shelf.depth * self.shelf.width)

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


GRAVITY = 9.81
"""Acceleration of free fall (m/s^2)."""


def coulomb_with_board(scene: Scene, item: SceneObject) -> float:
    """The coefficient of friction between an object and the board."""
    return scene.shelf.board_friction if item.friction is None else item.friction


def drag_on_board(scene: Scene, item: SceneObject) -> float:
    """The force that keeps an object sliding on the board, Coulomb's mu m g (N)."""
    return coulomb_with_board(scene, item) * item.mass * GRAVITY
