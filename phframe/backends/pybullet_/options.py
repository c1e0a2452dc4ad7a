"""Options of the PyBullet backend, and what its bodies are like to touch."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field

from phframe.backends.articulated import JointEngineOptions

LEAST_FRICTION = 1e-3
"""An object's own coefficient where there is no friction between objects: not 0, by which nothing can be multiplied."""


class PybulletOptions(JointEngineOptions):
    """Options of the PyBullet backend, besides those that all engines of joints have.

    Bullet multiplies the coefficients of two bodies that touch. So that every pair has its own, whatever the others
    have, objects have the root of that between objects, all else what makes the product right, and there is a board for
    every coefficient that objects have with it. Turning on the spot is resisted by boards, walls and arm.

    Attributes:
        iterations: Of the contact solver in a step.
        joint_gain: Speed of a joint of the arm per error (1/s).
        arm_stiffness: Of the arm's collision geometry at every point of contact (N/m): rigid, every touch would be a blow.
        arm_damping: Of the same (Ns/m).
        wall_stiffness: Of walls and ceiling at every point where an object meets them (N/m).
        wall_damping: Of the same (Ns/m).
    """

    iterations: Annotated[int, Field(ge=10, le=1000)] = 50
    joint_gain: Annotated[float, Field(gt=0.0, le=500.0)] = 60.0
    arm_stiffness: Annotated[float, Field(ge=100.0, le=1e6)] = 5e3
    arm_damping: Annotated[float, Field(ge=0.0, le=1e4)] = 50.0
    wall_stiffness: Annotated[float, Field(ge=100.0, le=1e6)] = 2e4
    wall_damping: Annotated[float, Field(ge=0.0, le=1e4)] = 200.0

    @property
    def own_friction(self) -> float:
        """The coefficient that objects themselves have in Bullet."""
        return max(math.sqrt(self.object_friction), LEAST_FRICTION)

    def against_objects(self, coefficient: float) -> dict[str, float]:
        """What a body has in Bullet so that objects have a coefficient with it."""
        own = self.own_friction
        return {"lateralFriction": coefficient / own, "spinningFriction": self.turning_friction / own}
