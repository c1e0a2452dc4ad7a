"""Physics in space with PyBullet: board, walls, ceiling, objects that may tip, roll and fall, an arm moved by its joints.

The arm is its own URDF. Every joint has a motor with the joint's real speed and effort: a constraint, rigid up to that
effort, so that arm and walls are given covers that yield where they touch. Joints carry the arm's weight besides that.
The arm is never put anywhere by hand while it can touch something, and holds what it holds by friction alone. A force
on it above the trajectory's limit stalls it; it then complies until nothing presses on it. An object that leaves the
board is spilled, and is taken out of the world.

With a step of 2 ms and 50 iterations, none of the objects of the published scenes moves more than 0.02 mm in 5 s.

``restore`` empties the client and builds the world anew: the only way, besides a new client, by which a run repeats
bit by bit whatever ran before. A sweep among five objects, repeated after other runs, ended this far from where it did
at first, for so long a restore:

===============================================  =========  ====
how the world is put back                        apart (m)  ms
===============================================  =========  ====
``resetSimulation``, then all built anew (used)  0          6
a new client, all built anew                     0          25
all bodies removed and added again               2e-3       5
poses and speeds written                         2e-3       0.1
``restoreState``, nothing asleep                 6e-4       0.1
``restoreState``, some asleep                    0.2        0.1
===============================================  =========  ====

For the same reason a snapshot is a state with its speeds: what follows from one repeats to the bit, but what Bullet
remembers of its contacts is lost.
"""

from __future__ import annotations

from functools import cached_property
from typing import Annotated

from pydantic import Field

from phframe.backends.articulated.physics import JointOptions, JointPhysics
from phframe.backends.pybullet_.bodies import Surfaces
from phframe.backends.pybullet_.snapshot import Snapshot, put_back, take_snapshot
from phframe.backends.pybullet_.urdf import PreparedUrdf, prepared_urdf
from phframe.backends.pybullet_.world import Engine, World


class PybulletOptions(JointOptions):
    """Options of the PyBullet backend, besides those that all engines of joints have.

    Attributes:
        iterations: Of the contact solver in a step.
        joint_gain: Speed of a joint of the arm per error (1/s).
    """

    iterations: Annotated[int, Field(ge=10, le=1000)] = 50
    joint_gain: Annotated[float, Field(gt=0.0, le=500.0)] = 60.0


class PybulletPhysics(JointPhysics[PybulletOptions, World, Snapshot]):
    """PyBullet 3 behind the Physics interface."""

    options_type = PybulletOptions

    @cached_property
    def urdf(self) -> PreparedUrdf:
        """The arm's URDF, made fit when it is first needed."""
        return prepared_urdf(self.arm)

    def close(self) -> None:
        """Give the engine's client back."""
        if self._world is not None:
            self._world.close()
        super().close()

    def _new_world(self) -> World:
        o = self.options
        surfaces = Surfaces(o.object_friction, o.arm_friction, o.turning_friction, o.rolling_friction)
        engine = Engine(o.step, o.iterations, o.joint_gain, surfaces, o.sleep)
        return World(self.scene, self.arm, self.base_pose, self.urdf, engine)

    def _take(self, world: World) -> Snapshot:
        return take_snapshot(world)

    def _put_back(self, world: World, snapshot: Snapshot) -> None:
        put_back(world, snapshot)
