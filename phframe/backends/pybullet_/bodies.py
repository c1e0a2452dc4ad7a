"""Makes boxes, planes and objects in PyBullet, each with the friction that it is to have with others."""

from __future__ import annotations

from phframe.backends.pybullet_.options import PybulletOptions
from phframe.backends.pybullet_.output_capture import bullet
from phframe.backends.pybullet_.shapes import collision_shape
from phframe.core import FloatArray, SceneObject
from phframe.geometry.slabs import Slab, Vector

ARM, OBJECT, PLANE, BOX, BOARDS, HELD, ENDS = 1, 2, 4, 8, 16, 32, 64
"""Collision bits of the arm, of objects, of what those meet at walls, of what the arm meets, of boards that objects stand on,
of objects that are held, of what those meet at walls. Bullet lets two bodies meet where either has the other's bit in its
mask: every pair is in both."""
ARM_MEETS, OBJECT_MEETS, HELD_MEETS = OBJECT | HELD | BOX, ARM | OBJECT | HELD | PLANE, ARM | OBJECT | ENDS
"""What the arm meets, and objects besides the boards that they stand on."""


class BodyMaker:
    """Makes bodies in a client.

    Args:
        client: PyBullet's.
        options: Of the backend.
    """

    def __init__(self, client: int, options: PybulletOptions) -> None:
        self._client, self._options = client, options
        # Bodies without one are given a mesh to look at, which takes longer than all the rest.
        self._look = bullet.createVisualShape(bullet.GEOM_BOX, halfExtents=[0.01] * 3, physicsClientId=client)

    def box(self, slab: Slab, bits: int, meets: int) -> int:
        """What the arm meets, or what something held stands on."""
        half = [length / 2.0 for length in slab.size]
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=half, physicsClientId=self._client)
        body = self._body(0.0, shape, slab.center, bits, meets)
        self._set(body, lateralFriction=self._options.own_friction)  # with the arm, as objects have it
        return body

    def wall(self, slab: Slab, friction: float) -> int:
        """What something held meets at a wall."""
        body = self.box(slab, ENDS, HELD)
        self._set(body, **self._options.against_objects(friction))
        self.soften(body)
        return body

    def plane(self, point: Vector, normal: Vector, friction: float, bits: int, meets: int) -> int:
        """What objects stand on or meet at a wall."""
        shape = bullet.createCollisionShape(bullet.GEOM_PLANE, planeNormal=normal, physicsClientId=self._client)
        body = self._body(0.0, shape, point, bits, meets)
        self._set(body, **self._options.against_objects(friction))
        return body

    def soften(self, body: int) -> None:
        """Let a body give where it is touched."""
        o = self._options
        self._set(body, contactStiffness=o.wall_stiffness, contactDamping=o.wall_damping)

    def item(self, item: SceneObject, pose: FloatArray) -> int:
        """An object, at rest.

        Raises:
            UnknownShapeError: If PyBullet has no primitive for its shape.
        """
        shape = collision_shape(self._client, item.shape)
        place, (w, *xyz) = pose[:3].tolist(), pose[3:].tolist()
        body = self._body(item.mass, shape, place, OBJECT, OBJECT_MEETS, [*xyz, w])
        self._set(
            body,
            lateralFriction=self._options.own_friction,
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
