"""Physics in space with MuJoCo: board, walls, ceiling, objects that may tip, roll and fall, an arm moved by its joints.

The arm is its own URDF, held by a position servo on every joint that gives no more than the joint's real effort; it is
never put anywhere by hand while it can touch something. What it holds, it holds by friction alone. A force on the arm
above the trajectory's limit stalls it; it then complies until nothing presses on it. An object that leaves the board is
spilled, and is taken out of the world.

MuJoCo's elliptic friction cone and a step of 2 ms keep the published scenes at rest; objects sink 0.1 mm into the board.
"""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Literal

import mujoco
from pydantic import Field

from phframe.backends.articulated.physics import JointOptions, JointPhysics
from phframe.backends.mujoco_.model import Controls, Model, build_model
from phframe.backends.mujoco_.shelf import Surfaces
from phframe.backends.mujoco_.snapshot import Snapshot, put_back, take_snapshot
from phframe.backends.mujoco_.world import World


class MujocoOptions(JointOptions):
    """Options of the MuJoCo backend, besides those that all engines of joints have.

    Attributes:
        cone: Of friction: ``elliptic`` is Coulomb's, ``pyramidal`` an approximation.
        friction_firmness: Stiffness of friction over that of contact (MuJoCo's impratio): less creep in the hand.
        joint_give: Error at which a joint of the arm gives its whole effort (rad or m).
        finger_give: The same of a finger (m).
    """

    cone: Literal["elliptic", "pyramidal"] = "elliptic"
    friction_firmness: Annotated[float, Field(ge=1.0, le=100.0)] = 3.0
    joint_give: Annotated[float, Field(gt=0.0, le=0.2)] = 0.01
    finger_give: Annotated[float, Field(gt=0.0, le=0.05)] = 0.002


class MujocoPhysics(JointPhysics[MujocoOptions, World, Snapshot]):
    """MuJoCo 4 behind the Physics interface.

    ``restore`` resets the engine's data completely, warm starts and sleep included, so ``simulate`` repeats bit by bit.
    """

    options_type = MujocoOptions

    @cached_property
    def model(self) -> Model:
        """The compiled model, made when it is first needed."""
        o = self.options
        surfaces = Surfaces(o.object_friction, o.turning_friction, o.rolling_friction, o.cone, o.friction_firmness)
        controls = Controls(o.joint_give, o.finger_give, o.arm_friction)
        return build_model(self.scene, self.arm, self.base_pose, surfaces, controls, step=o.step, sleep=o.sleep)

    def close(self) -> None:
        """Drop the engine's data and model."""
        super().close()
        self.__dict__.pop("model", None)

    def _new_world(self) -> World:
        return World(self.model, mujoco.MjData(self.model.mj))

    def _take(self, world: World) -> Snapshot:
        return take_snapshot(world)

    def _put_back(self, world: World, snapshot: Snapshot) -> None:
        put_back(world, snapshot)
