"""The interface of arms, and what a planner may know of one: its outlines seen from above."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from phframe.core.errors import ArmError
from phframe.core.options import Options
from phframe.core.scene import Mount, Shelf
from phframe.core.value import FloatArray, Floats, Value


@dataclass(frozen=True, slots=True, eq=False)
class Outline(Value):
    """A convex part of an arm seen from above.

    Attributes:
        part: Its name, such as ``link`` or ``left finger``.
        vertices: ``(k, 2)`` counter-clockwise, in the fingertip frame (m): the origin is at the tip of the closed
            fingers, x points ahead, y to the left.
        side: Which way it moves as the gripper opens, by half the opening: +1 to the left, -1 to the right, 0 not.
    """

    part: str
    vertices: Floats
    side: int = 0

    def __post_init__(self) -> None:
        self._freeze("vertices")

    def opened(self, opening: float) -> Outline:
        """The outline as it lies with the fingers ``opening`` (m) apart."""
        return Outline(self.part, self.vertices + [0.0, self.side * opening / 2.0], self.side)


@dataclass(frozen=True, slots=True)
class ArmShape:
    """All that planning in the plane needs to know of an arm.

    Attributes:
        closed: Outlines of fingers, gripper, wrist and link with the fingers closed, each as wide as it really is at
            its distance behind the fingertip.
        link_width: Width of the arm where it is widest inside the shelf (m).
        insertion_width: Width of what goes in first, fingers closed (m).
        max_opening: Largest distance between the fingers (m).
    """

    closed: tuple[Outline, ...]
    link_width: float
    insertion_width: float
    max_opening: float

    def outlines(self, opening: float) -> tuple[Outline, ...]:
        """The outlines with the fingers ``opening`` (m) apart.

        Raises:
            ArmError: If the gripper cannot open that far.
        """
        if not 0.0 <= opening <= self.max_opening + 1e-9:
            raise ArmError(f"the gripper opens from 0 to {self.max_opening:g} m, not to {opening:g} m")
        return tuple(outline.opened(opening) for outline in self.closed)


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint of an arm.

    Attributes:
        name: Unique within the arm.
        lower: Least value (rad, or m where it slides).
        upper: Greatest value.
        velocity: Greatest speed (rad/s or m/s).
        effort: Greatest torque (Nm) or force (N).
    """

    name: str
    lower: float
    upper: float
    velocity: float
    effort: float


OptionsT = TypeVar("OptionsT", bound=Options)


class ArmModel(ABC, Generic[OptionsT]):
    """An arm's geometry and kinematics. Stateless; poses are ``(7,)`` in the frame of the arm's base."""

    options_type: ClassVar[type[Options]] = Options
    force_limit: ClassVar[float] = 60.0
    """Contact force (N) above which the arm stalls."""

    def __init__(self, options: OptionsT) -> None:
        self.options = options

    @property
    @abstractmethod
    def joints(self) -> tuple[Joint, ...]:
        """The joints, from the base to the gripper."""

    @property
    @abstractmethod
    def home(self) -> FloatArray:
        """Joint values ``(dof,)`` of the parked arm, outside the shelf."""

    @property
    @abstractmethod
    def shape(self) -> ArmShape:
        """The arm seen from above."""

    @abstractmethod
    def forward(self, q: ArrayLike) -> FloatArray:
        """Pose ``(7,)`` of the fingertip for joint values ``(dof,)``.

        Raises:
            ArmError: If ``q`` has the wrong length or is not finite.
        """

    @abstractmethod
    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        """Joint values ``(dof,)`` within limits that put the fingertip at ``pose`` ``(7,)``, near ``seed``; None: there are none."""

    @abstractmethod
    def default_mount(self, shelf: Shelf) -> Mount:
        """Where the base stands for a shelf when the scene does not say."""

    @abstractmethod
    def urdf(self) -> str:
        """The arm as URDF text, meshes excluded."""

    def within_limits(self, q: ArrayLike) -> bool:
        """Whether joint values ``(dof,)`` respect every limit."""
        lower, upper = np.array([[j.lower, j.upper] for j in self.joints]).T
        values = np.asarray(q, dtype=np.float64)
        return bool(((values >= lower - 1e-9) & (values <= upper + 1e-9)).all())
