"""Spares PyBullet work: what is at rest sleeps until something touches it, and only what has toppled can roll.

Bullet's own rule lets bodies sleep that have been slower than a threshold for 2 s, so all would be awake most of the
time; here a tenth of a second will do. Bullet itself wakes whatever an awake body touches.
"""

from __future__ import annotations

import math

from phframe.backends.articulated import ObjectReading
from phframe.backends.pybullet_.options import PybulletOptions
from phframe.backends.pybullet_.output_capture import bullet
from phframe.backends.pybullet_.shelf import Bodies
from phframe.core import FloatArray, Scene, coulomb_with_board
from phframe.core.condition import TOPPLED_TILT

CALM = 1e-3
"""What is slower than this (m/s) ..."""
LONG = 3
"""... at so many looks one after the other is at rest."""
LOOK = 10
"""Control steps between looks."""

LEANING = (1.0 - math.cos(TOPPLED_TILT)) / 2.0
"""What has toppled has more than this in the squares of its quaternion's x and y."""


class Rest:
    """What sleeps and what rolls in a world that has just been built.

    Args:
        client: PyBullet's.
        scene: What is in it.
        bodies: Where it is.
        options: Of the backend.
    """

    def __init__(self, client: int, scene: Scene, bodies: Bodies, options: PybulletOptions) -> None:
        self._client, self._scene, self._bodies, self._options = client, scene, bodies, options
        self._radii: list[float] = scene.radii.tolist()
        self._calm = [0] * len(scene.objects)
        self._rolls: set[int] = set()
        for body in bodies.objects.values() if options.sleep else ():
            self._set(body, activationState=bullet.ACTIVATION_STATE_ENABLE_SLEEPING, sleepThreshold=CALM**2)

    def look(self, objects: ObjectReading) -> None:
        """Let what is at rest sleep and what has toppled roll."""
        self.let_roll(objects.poses)
        if not self._options.sleep:
            return
        for row, (x, y, z, roll, pitch, yaw) in enumerate(objects.velocities.tolist()):
            speed = math.hypot(x, y, z) + math.hypot(roll, pitch, yaw) * self._radii[row]
            self._calm[row] = calm = self._calm[row] + 1 if speed < CALM else 0
            if calm and calm % LONG == 0 and row in self._bodies.objects:
                self._set(self._bodies.objects[row], activationState=bullet.ACTIVATION_STATE_SLEEP)

    def let_roll(self, poses: FloatArray) -> None:
        """Let what has toppled meet resistance to rolling; what stands has none, which is quicker by a third."""
        leaning = poses[:, 4] ** 2 + poses[:, 5] ** 2 > LEANING
        for row in leaning.nonzero()[0].tolist():
            body = self._bodies.objects.get(row)
            if body is not None and row not in self._rolls:
                self._rolls.add(row)
                board = coulomb_with_board(self._scene, self._scene.objects[row])
                own = self._options.own_friction
                # Bullet's product is with the other's sliding friction, which has made the board's own.
                self._set(body, rollingFriction=self._options.rolling_friction * own / board if board else 0.0)

    def _set(self, body: int, **dynamics: float) -> None:
        bullet.changeDynamics(body, -1, **dynamics, physicsClientId=self._client)
