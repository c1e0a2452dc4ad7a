"""The interface of arms, and what a planner may know of one: its outlines seen from above."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Generic, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phframe.core.errors import ArmError
from phframe.core.mesh import LinkMesh
from phframe.core.options import Options
from phframe.core.pose import compose, inverse, planar_pose, rotated_in_plane, rotation_matrix, seen_from_above
from phframe.core.shelf import BasePose, Shelf
from phframe.core.unreachable import Unreachable
from phframe.core.value import FloatArray, Floats, Value, short_repr

if TYPE_CHECKING:
    from phframe.core.scene import Scene
    from phframe.core.state import State

FINGER_ROOM = 0.003
"""Least room between an object and each of the open fingers that go around it (m)."""
GRAZING = 1e-6
"""Heights that differ by less (m) only touch: what passes over something passes over what is no more than this higher."""
LEAST_SERVED = 0.7
"""Fraction of the shelf over which the joints of an arm that is to be driven by them must take its fingertip."""


@dataclass(frozen=True, slots=True, eq=False)
class Outline(Value):
    """A convex part of an arm seen from above.

    Attributes:
        part: Its name, such as ``link`` or ``left finger``.
        vertices: ``(k, 2)`` counter-clockwise, in the fingertip frame (m): the origin is at the tip of the closed
            fingers, x points ahead, y to the left.
        side: Which way it moves as the gripper opens, by half of what it opens: +1 to the left, -1 to the right, 0 not.
        bottom: Lowest z relative to the gripper plane (m).
        top: Highest z relative to the gripper plane (m).
    """

    part: str
    vertices: Floats
    side: int = 0
    bottom: float = -0.02
    top: float = 0.02

    def __post_init__(self) -> None:
        self._freeze("vertices")

    def opened(self, distance: float) -> Outline:
        """The outline as it lies with the fingers ``distance`` (m) farther apart than closed."""
        return replace(self, vertices=self.vertices + np.array([0.0, self.side * distance / 2.0]))


@dataclass(frozen=True, slots=True)
class ArmShape:
    """All that planning in the plane needs to know of an arm.

    Attributes:
        closed: Outlines of fingers, gripper, wrist and link with the fingers closed, each as wide as it really is at
            its distance behind the fingertip.
        link_width: Width of the arm where it is widest inside the shelf (m).
        insertion_width: Width of what goes in first, fingers closed (m).
        max_opening: Largest distance between the fingers (m).
        min_opening: Their distance when closed (m); not 0 for every gripper.
        height: Of the gripper plane above the board (m).
    """

    closed: tuple[Outline, ...]
    link_width: float
    insertion_width: float
    max_opening: float
    min_opening: float = 0.0
    height: float = 0.06

    __repr__ = short_repr

    @property
    def fingers_bottom(self) -> float:
        """Of the fingers above the board (m): they pass over what is no taller, and cannot grasp it."""
        return self.height + min(outline.bottom for outline in self.closed if outline.side or not self._has_fingers)

    @property
    def top(self) -> float:
        """Of its highest part above the board (m)."""
        return self.height + max(outline.top for outline in self.closed)

    def front(self, yaw: float) -> float:
        """How far the closed arm stands out ahead of its fingertip, along the shelf's x axis, at a yaw (m)."""
        turn = rotation_matrix(yaw).T
        return max(float(rotated_in_plane(outline.vertices, turn)[:, 0].max()) for outline in self.closed)

    def meets(self, height: float) -> tuple[bool, ...]:
        """For each part of ``closed``, whether it meets what stands on the board and is so tall (m), or passes over it."""
        return tuple(self.height + outline.bottom < height - GRAZING for outline in self.closed)

    @property
    def _has_fingers(self) -> bool:
        return any(outline.side for outline in self.closed)

    def met(self, scene: Scene) -> NDArray[np.bool_]:
        """Which objects of a scene ``(n,)`` the arm meets with any part; it passes over the others."""
        return np.array([any(self.meets(item.shape.height)) for item in scene.objects])

    def outlines(self, opening: float) -> tuple[Outline, ...]:
        """The outlines with the fingers ``opening`` (m) apart.

        Raises:
            ArmError: If the gripper cannot open that far.
        """
        if not self.min_opening - 1e-9 <= opening <= self.max_opening + 1e-9:
            raise ArmError(
                f"the gripper opens from {self.min_opening:g} to {self.max_opening:g} m, not to {opening:g} m"
            )
        return tuple(outline.opened(opening - self.min_opening) for outline in self.closed)


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


@dataclass(frozen=True, slots=True)
class Fingers:
    """A gripper's mechanism: two coupled fingers that slide.

    Attributes:
        joints: Left and right, as named in the URDF; each travels half of what the gripper opens. Their effort is the
            grip force of one finger (N).
        links: Left and right: what a grasp must touch, as named in the URDF.
    """

    joints: tuple[Joint, Joint]
    links: tuple[str, str]


OptionsT = TypeVar("OptionsT", bound=Options)


class ArmModel(ABC, Generic[OptionsT]):
    """An arm's geometry and kinematics. Stateless.

    Poses ``(7,)`` are of the fingertip frame (x ahead, y left, z up with the gripper level) in the frame of the base.
    """

    options_type: ClassVar[type[Options]] = Options
    tip_link: ClassVar[str] = "fingertip"
    """The link of the URDF that ``forward`` gives the pose of."""

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
    def fingers(self) -> Fingers:
        """The gripper's mechanism."""

    @property
    def force_limit(self) -> float:
        """Net contact force (N) above which the arm stalls."""
        return 60.0

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
        """Joint values ``(dof,)`` within limits that put the fingertip at ``pose`` ``(7,)``, near ``seed``, or None.

        Raises:
            ArmError: If ``pose`` is not seven finite numbers.
        """

    @abstractmethod
    def default_base_pose(self, shelf: Shelf) -> BasePose:
        """Where the base stands for a shelf when the scene does not say."""

    @abstractmethod
    def urdf(self) -> str:
        """The arm as URDF text, made of primitives, and of meshes that count as their convex hulls.

        Its joints and links bear the names in ``joints``, ``fingers`` and ``tip_link``; inertias, limits and collision
        shapes are the real ones.
        """

    def meshes(self) -> tuple[LinkMesh, ...]:
        """What links really look like, for pictures; a link without any is drawn as the primitives of ``urdf``."""
        return ()

    def gripper_pose(self, q: ArrayLike, base_pose: BasePose) -> FloatArray:
        """Fingertip pose seen from above ``(3,)``, x, y (m), yaw (rad) in the shelf frame, for joint values ``(dof,)``."""
        return seen_from_above(compose(base_pose.pose, self.forward(q)))

    def fingertip_pose(self, gripper: ArrayLike, base_pose: BasePose) -> FloatArray:
        """Pose ``(7,)`` in the frame of the base of a fingertip that is level in the gripper plane at ``(3,)``: x, y, yaw."""
        x, y, yaw = np.asarray(gripper, dtype=np.float64).tolist()
        return compose(inverse(base_pose.pose), planar_pose(x, y, self.shape.height, yaw))

    @property
    def mount(self) -> BasePose | None:
        """Where the options have the base stand, whatever a scene says; None: they do not say."""
        return None

    def mounted(self, scene: Scene, told: Callable[[int, int], None] = lambda done, of: None) -> Self:
        """The arm as it is in a scene: with what its options leave to the scene chosen. By default the arm itself.

        Args:
            scene: The scene.
            told: Is told how many of how many choices have been looked at.
        """
        return self

    def out_of_reach(self, scene: Scene, state: State, base_pose: BasePose, object_id: str) -> Unreachable | None:
        """How far the joints get towards an object, if they cannot have it grasped where it stands even in an empty shelf.

        None: they can, or it is not known.
        """
        return None

    def fraction_served(self, shelf: Shelf, base_pose: BasePose, enough: float = 1.0) -> float | None:
        """Of a shelf, the fraction over which the joints can take the fingertip.

        Args:
            shelf: The shelf.
            base_pose: Where the base stands.
            enough: Once so much is known to be served, no more is looked for.

        Returns:
            None: not known, and found out pose by pose.
        """
        return None

    def within_limits(self, q: ArrayLike) -> bool:
        """Whether joint values ``(dof,)`` respect every limit."""
        lower, upper = np.array([[j.lower, j.upper] for j in self.joints]).T
        values = np.asarray(q, dtype=np.float64)
        return bool(((values >= lower - 1e-9) & (values <= upper + 1e-9)).all())
