"""Boxes, planes and cylinders in PyBullet, and what they are like to touch.

Bullet multiplies the coefficients of two bodies that touch. So that every pair has its own, whatever the others
have, objects have the root of that between objects, all else what makes the product right, and there is a board for
every coefficient that objects have with it. Turning on the spot is resisted by boards, walls and arm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from phframe.backends.pybullet_.output_capture import bullet
from phframe.core import FloatArray, SceneObject
from phframe.geometry.slabs import Slab, Vector

WALL_STIFFNESS, WALL_DAMPING = 2e4, 200.0
"""Of walls and ceiling at every point where an object meets them (N/m, Ns/m): what is pressed into them is not hit."""
LEAST = 1e-3
"""An object's own coefficient where there is no friction between objects: not 0, by which nothing can be multiplied."""
ARM, OBJECT, PLANE, BOX, BOARDS = 1, 2, 4, 8, 16
"""Collision bits of the arm, of objects, of what objects meet at walls, of what the arm meets, of boards that objects stand on."""
OBJECT_MEETS = ARM | OBJECT | PLANE
"""What any object meets, besides the board that it stands on."""


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Friction between bodies.

    Attributes:
        objects: Coulomb coefficient of object against object.
        arm: Of the arm against all else.
        turning: Against turning on the spot (m).
        rolling: Against rolling (m).
    """

    objects: float
    arm: float
    turning: float
    rolling: float

    @property
    def own(self) -> float:
        """The coefficient that objects themselves have in Bullet."""
        return max(math.sqrt(self.objects), LEAST)

    def against_objects(self, coefficient: float) -> dict[str, float]:
        """What a body has in Bullet so that objects have a coefficient with it."""
        own = self.own
        return {"lateralFriction": coefficient / own, "spinningFriction": self.turning / own}


class Maker:
    """Makes bodies in a client.

    Args:
        client: PyBullet's.
        surfaces: Friction.
    """

    def __init__(self, client: int, surfaces: Surfaces) -> None:
        self._client, self._surfaces = client, surfaces
        # Bodies without one are given a mesh to look at, which takes longer than all the rest.
        self._look = bullet.createVisualShape(bullet.GEOM_BOX, halfExtents=[0.01] * 3, physicsClientId=client)

    def box(self, slab: Slab, bits: int, meets: int) -> int:
        """What the arm meets, or something held."""
        half = [length / 2.0 for length in slab.size]
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=half, physicsClientId=self._client)
        body = self._body(0.0, shape, slab.center, bits, meets)
        self._set(body, lateralFriction=self._surfaces.own)  # with the arm, as objects have it
        return body

    def plane(self, point: Vector, normal: Vector, friction: float, bits: int, meets: int) -> int:
        """What objects stand on or meet at a wall."""
        shape = bullet.createCollisionShape(bullet.GEOM_PLANE, planeNormal=normal, physicsClientId=self._client)
        body = self._body(0.0, shape, point, bits, meets)
        self._set(body, **self._surfaces.against_objects(friction))
        return body

    def soften(self, body: int) -> None:
        """Let a body give where it is touched."""
        self._set(body, contactStiffness=WALL_STIFFNESS, contactDamping=WALL_DAMPING)

    def cylinder(self, item: SceneObject, pose: FloatArray) -> int:
        """An object, at rest."""
        radius, height = item.shape.radius, item.shape.height
        shape = bullet.createCollisionShape(
            bullet.GEOM_CYLINDER, radius=radius, height=height, physicsClientId=self._client
        )
        place, (w, *xyz) = pose[:3].tolist(), pose[3:].tolist()
        body = self._body(item.mass, shape, place, OBJECT, OBJECT_MEETS, [*xyz, w])
        self._set(
            body,
            lateralFriction=self._surfaces.own,
            spinningFriction=0.0,
            rollingFriction=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
        )
        return body

    def _body(
        self, mass: float, shape: int, place: Vector | list[float], bits: int, meets: int, turned: object = (0, 0, 0, 1)
    ) -> int:
        body: int = bullet.createMultiBody(
            mass, shape, self._look, basePosition=place, baseOrientation=turned, physicsClientId=self._client
        )
        bullet.setCollisionFilterGroupMask(body, -1, bits, meets, physicsClientId=self._client)
        return body

    def _set(self, body: int, **dynamics: float) -> None:
        bullet.changeDynamics(body, -1, **dynamics, physicsClientId=self._client)
