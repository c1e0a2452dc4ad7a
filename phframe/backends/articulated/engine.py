"""What an engine has to do to move an arm by its joints: a Protocol, and the records in which it answers.

An engine knows bodies, joints and contacts, and nothing of what a ``State`` is made of: what is held, what has spilled
and whether the arm is parked is kept by ``ArticulatedWorld``, which tells the engine what it has to do about it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from phframe.core import ArmModel, BasePose, FloatArray, Scene

Vector = tuple[float, float, float]
"""x, y, z."""
Progress = tuple[float, float, float, float]
"""After a control step: x and y of the fingertip (m), number of contacts of the arm, net force of those on it (N)."""


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Where everything is to be, at rest.

    Attributes:
        poses: Of every object ``(n, 7)`` in the shelf frame.
        spilled: Rows of the objects that are not in the world.
        joints: Values of the arm's joints ``(dof,)``.
        fingers: Of the two finger joints ``(2,)``.
        commanded_fingers: What the two finger joints are told to be ``(2,)``, beyond what they squeeze.
    """

    poses: FloatArray
    spilled: frozenset[int]
    joints: FloatArray
    fingers: FloatArray
    commanded_fingers: FloatArray


class ArmReading(NamedTuple):
    """The arm as it is now.

    Attributes:
        joints: Values of the arm's joints ``(dof,)``.
        fingers: Of the two finger joints ``(2,)``.
        commanded_fingers: What the two finger joints are told to be ``(2,)``.
        gripper: Fingertip pose ``(3,)`` in the shelf frame.
        efforts: Magnitude of the force or torque that each of the arm's joints gave in the last step ``(dof,)``.
        inertias: What each of the arm's joints has to accelerate ``(dof,)`` (kg or kg m^2): the diagonal of the joint-space
            inertia matrix, here or at joint values of 0.
    """

    joints: FloatArray
    fingers: FloatArray
    commanded_fingers: FloatArray
    gripper: FloatArray
    efforts: FloatArray
    inertias: FloatArray


class ObjectReading(NamedTuple):
    """The objects as they are now; finite numbers of any value for those that have spilled.

    Attributes:
        poses: ``(n, 7)`` in the shelf frame.
        velocities: ``(n, 6)``, straight (m/s) and turning (rad/s).
    """

    poses: FloatArray
    velocities: FloatArray


class ContactPair(NamedTuple):
    """A part of the arm and what it touches. Engines ask for the same ones again and again: make each once.

    Attributes:
        part: Of the arm: as its outline is called, or else its link.
        body: What it touches: an object's id, a wall, the ceiling, the board.
        wall: Whether that is a wall or the ceiling.
        row: Of the object, None for others.
        finger: Which finger the part is: +1 left, -1 right, 0 none.
    """

    part: str
    body: str
    wall: bool
    row: int | None
    finger: int


EngineContact = tuple[ContactPair, Vector]
"""One of the arm's contacts: who touches what, and the direction, of any length, in which the arm pushes it."""


class JointEngine(Protocol):
    """A scene with an arm in an engine.

    Args:
        scene: The scene.
        arm: The arm.
        base_pose: Of the arm.
        options: Of the backend.

    Attributes:
        name: The backend's name, for messages.
        period: Duration of a control step (s): see ``substeps``.
        delay: How old the place of the fingertip is that ``advance`` tells (s); 0 for most.

    Raises:
        IncompatibleError: If the engine cannot have the arm.
        UnknownShapeError: If it has no primitive for the shape of an object.
    """

    name: str
    period: float
    delay: float

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: Any) -> None: ...

    def place(self, placement: Placement) -> None:
        """Put everything in its place, at rest, with nothing remembered of what ran before: runs repeat bit by bit.

        Joints are held where they are with their whole effort, and no object counts as held.
        """

    def arm(self) -> ArmReading:
        """The arm as it is now. Reading changes nothing."""

    def objects(self) -> ObjectReading:
        """The objects as they are now. Reading changes nothing."""

    def contacts(self) -> Iterable[EngineContact]:
        """The arm's contacts with anything else, told apart by body, whatever names its shapes have or lack."""

    def trouble(self) -> str | None:
        """Why the engine's numbers are no longer physical, apart from objects that are too fast; None: they are."""

    def controls(self, positions: FloatArray, velocities: FloatArray, fingers: FloatArray) -> Sequence[Any]:
        """What ``command`` is given at each of ``k`` control steps: joints and speeds ``(k, dof)``, fingers ``(k, 2)``."""

    def command(self, control: Any) -> None:
        """Tell arm and fingers where to be as the next control step ends: one of ``controls``."""

    def cap(self, efforts: FloatArray) -> None:
        """Let the arm's joints give no more than this ``(dof,)`` (N or Nm); their weight is carried besides."""

    def comply(self) -> None:
        """Ask nothing of the arm but to lose its speed where it is; what presses on it may push it back."""

    def advance(self) -> Progress:
        """Let one control step pass. The hot path."""

    def remove(self, row: int) -> None:
        """Take an object out of the world: it has spilled."""

    def set_held(self, row: int, *, held: bool) -> None:
        """Let an object meet a board and walls that end at the mouth, as it must while it is held, or no longer.

        What is not held may meet endless planes, on which many engines keep things more still than on boxes.
        """

    def running(self) -> AbstractContextManager[object]:
        """What an engine needs around a run; ``contextlib.nullcontext()`` where that is nothing."""

    def memory(self) -> FloatArray:
        """What the next step depends on besides a ``State``, as numbers ``(m,)``: speeds, and whatever else it keeps."""

    def recall(self, memory: FloatArray) -> None:
        """Take up, right after ``place`` and ``set_held``, what ``memory`` gave."""

    def close(self) -> None:
        """Give the engine's own memory back. May be called twice."""


def substeps(step: float, period: float) -> int:
    """How many steps (s) of an engine make up a control step that lasts about a period (s); at least 1."""
    return max(1, round(period / step))
