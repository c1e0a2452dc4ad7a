"""Options of the MuJoCo backend."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from phframe.backends.articulated import JointEngineOptions


class MujocoOptions(JointEngineOptions):
    """Options of the MuJoCo backend, besides those that all engines of joints have.

    Attributes:
        cone: Of friction: ``elliptic`` is Coulomb's, ``pyramidal`` an approximation.
        friction_firmness: Stiffness of friction over that of contact (MuJoCo's impratio): less creep in the hand.
        contact_time: In which what is pressed into something comes out of it (s; MuJoCo's solref): stiff, and critically
            damped, so that what is hit hardly rebounds. Not below two steps.
        joint_give: Error at which a joint of the arm gives its whole effort (rad or m).
        finger_give: The same of a finger (m).
    """

    cone: Literal["elliptic", "pyramidal"] = "elliptic"
    friction_firmness: Annotated[float, Field(ge=1.0, le=100.0)] = 3.0
    contact_time: Annotated[float, Field(ge=0.002, le=0.2)] = 0.02
    joint_give: Annotated[float, Field(gt=0.0, le=0.2)] = 0.01
    finger_give: Annotated[float, Field(gt=0.0, le=0.05)] = 0.002

    @property
    def contact(self) -> tuple[float, float]:
        """Time constant (s) and damping ratio of contacts."""
        return self.contact_time, 1.0

    def triple(self, coefficient: float) -> list[float]:
        """Friction against sliding, turning and rolling, as MuJoCo wants them."""
        return [coefficient, self.turning_friction, self.rolling_friction]
