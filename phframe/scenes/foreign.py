"""What a scene of another program is made of, before a shelf has been found in it. Everything stands in its own world."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from phframe.core import Floats, Value


@dataclass(frozen=True, slots=True, eq=False)
class Block(Value):
    """A box that never moves.

    Attributes:
        name: As the file has it, or what it is where it has no name.
        center: ``(3,)`` (m).
        axes: ``(3, 3)``, the box's axes as columns.
        half: ``(3,)`` half of its lengths along them (m).
        friction: Coulomb coefficient.
        priority: Whose coefficient counts in a contact: that of the higher; of equals the greater coefficient.
        endless: Whether it is the half-space behind a plane, given as a very large box.
    """

    name: str
    center: Floats
    axes: Floats
    half: Floats
    friction: float
    priority: int
    endless: bool = False

    def __post_init__(self) -> None:
        self._freeze("center", "axes", "half")


@dataclass(frozen=True, slots=True, eq=False)
class FreeBody(Value):
    """An upright cylinder that may move.

    Attributes:
        name: Unique.
        center: ``(3,)`` (m).
        yaw: Heading (rad).
        radius: Metres.
        height: Metres.
        mass: Kilograms.
        friction: Coulomb coefficient.
        priority: As of a ``Block``.
    """

    name: str
    center: Floats
    yaw: float
    radius: float
    height: float
    mass: float
    friction: float
    priority: int

    def __post_init__(self) -> None:
        self._freeze("center")

    @property
    def base(self) -> float:
        """Height of its underside (m)."""
        return float(self.center[2]) - self.height / 2.0


@dataclass(frozen=True, slots=True)
class ForeignScene:
    """What was read.

    Attributes:
        name: Of the model.
        blocks: What may be board, walls and ceiling.
        bodies: What may be objects.
        target: Name of the body that the file says is wanted; empty: it does not say.
        base_poses: Position and yaw ``(4,)`` (m, rad) of arms' bases, by the arms' names.
        ignored: What else there was, in words.
    """

    name: str
    blocks: tuple[Block, ...]
    bodies: tuple[FreeBody, ...]
    target: str
    base_poses: Mapping[str, Floats]
    ignored: tuple[str, ...]


def coefficient(a: Block | FreeBody, b: Block | FreeBody) -> float:
    """The coefficient of friction between two bodies, as MuJoCo has it."""
    if a.priority != b.priority:
        return a.friction if a.priority > b.priority else b.friction
    return max(a.friction, b.friction)


def listed(names: Iterable[str], most: int = 6) -> str:
    """Names in a sentence, the first of them where they are many."""
    every = [repr(name) for name in names]
    more = len(every) - most
    return ", ".join(every[:most]) + (f" and {more} more" if more > 0 else "")
