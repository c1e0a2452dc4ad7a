"""Physics in space with PyBullet: board, walls, ceiling, objects that may tip, roll and fall, an arm moved by its joints."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated

from pydantic import Field

from phframe.backends.joint_physics import JointOptions, JointPhysics, StallLag
from phframe.backends.pybullet_bodies import Surfaces
from phframe.backends.pybullet_snapshot import Snapshot, put_back, take_snapshot
from phframe.backends.pybullet_urdf import PreparedUrdf, prepared_urdf
from phframe.backends.pybullet_world import Engine, World

Coefficient = Annotated[float, Field(ge=0.0, le=2.0)]


class PybulletOptions(JointOptions):
    """Options of the PyBullet backend.

    Attributes:
        step: Time step (s).
        iterations: Of the contact solver in a step.
        sleep: Whether what is at rest is passed over until something touches it; twice as fast.
        object_friction: Coulomb coefficient between objects.
        arm_friction: Coulomb coefficient between the arm and all else.
        turning_friction: Of a contact against turning on the spot (m).
        rolling_friction: Of a contact against rolling (m).
        joint_gain: Speed of a joint of the arm per error (1/s).
        stall_lag: How far the fingertip may fall behind its trajectory before it counts as stalled (m).
    """

    step: Annotated[float, Field(gt=0.0, le=0.005)] = 0.002
    iterations: Annotated[int, Field(ge=10, le=1000)] = 50
    sleep: bool = True
    object_friction: Coefficient = 0.2
    arm_friction: Coefficient = 0.3
    turning_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.005
    rolling_friction: Annotated[float, Field(ge=0.0, le=0.1)] = 0.0005
    joint_gain: Annotated[float, Field(gt=0.0, le=500.0)] = 60.0
    stall_lag: StallLag = 0.015


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
        return World(self.scene, self.arm, self.mount, self.urdf, engine)

    def _take(self, world: World) -> Snapshot:
        return take_snapshot(world)

    def _put_back(self, world: World, snapshot: Snapshot) -> None:
        put_back(world, snapshot)
