"""What executing a trajectory did."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from phframe.core.gripper_path import Phase
from phframe.core.state import State
from phframe.core.unreachable import Unreachable
from phframe.core.value import Value, short_repr

FORCE_WINDOW = 0.02
"""Forces on the arm are means over this long (s)."""


@dataclass(frozen=True, slots=True)
class Contact:
    """The first time, in one phase, that a part of the arm touched something.

    Attributes:
        time: Seconds from the start of the motion.
        body: The object's id, or ``south wall``, ``north wall``, ``back wall``, ``ceiling``, ``board``.
        phase: What the arm was doing.
        part: Which part of the arm it was, as named in its outlines or its URDF.
    """

    time: float
    body: str
    phase: Phase
    part: str = ""


class StopCause(StrEnum):
    """What ended a motion before its trajectory did."""

    FORCE = "force"
    CONTACT = "contact"
    WALL = "wall"
    UNREACHABLE = "unreachable"


@dataclass(frozen=True, slots=True)
class StopReason:
    """Why a motion ended early.

    Attributes:
        cause: What ended it.
        body: What the arm touched, where that is the cause.
        force: The force on the arm (N), where that is the cause.
        unreachable: What the arm cannot do, where that is the cause: then nothing moved.
    """

    cause: StopCause
    body: str = ""
    force: float = 0.0
    unreachable: Unreachable | None = None

    def __str__(self) -> str:
        match self.cause:
            case StopCause.FORCE:
                return f"a force of {self.force:.0f} N"
            case StopCause.UNREACHABLE:
                return f"unreachable: {self.unreachable.why if self.unreachable else ''}"
            case _:
                return f"contact with {'the ' if self.cause is StopCause.WALL else ''}{self.body}"


@dataclass(frozen=True, slots=True)
class Motion:
    """What executing a trajectory did.

    Attributes:
        duration: Simulated or real time it took, settling included (s).
        contacts: First contact of each part of the arm with each object in each phase, in order of time.
        wall_contacts: The same with walls.
        largest_force: The largest force on the arm (N): magnitude of the sum of its contact forces, mean of 20 ms.
        stalled: Whether the force limit kept the arm from going on. It then stands where it stalled.
        stopped: Why the motion ended early, or None.
        tracking_error: Largest distance between where the fingertip was meant to be and where it was (m).
        settled: Whether everything came to rest in the time allowed.
        followed: How much of the trajectory was driven (s), settling excluded.
    """

    duration: float
    contacts: tuple[Contact, ...] = ()
    wall_contacts: tuple[Contact, ...] = ()
    largest_force: float = 0.0
    stalled: bool = False
    stopped: StopReason | None = None
    tracking_error: float = 0.0
    settled: bool = True
    followed: float = 0.0

    __repr__ = short_repr

    @property
    def complete(self) -> bool:
        """Whether the trajectory was followed to its end."""
        return not self.stalled and self.stopped is None

    def then(self, later: Motion) -> Motion:
        """This motion and the retreat after it as one: what went wrong in either is kept, times run on.

        How much of the trajectory was followed remains as it was: a retreat is not part of it.
        """
        return Motion(
            duration=self.duration + later.duration,
            contacts=_joined(self.contacts, later.contacts, self.duration),
            wall_contacts=_joined(self.wall_contacts, later.wall_contacts, self.duration),
            largest_force=max(self.largest_force, later.largest_force),
            stalled=self.stalled or later.stalled,
            stopped=self.stopped or later.stopped,
            tracking_error=max(self.tracking_error, later.tracking_error),
            settled=later.settled,
            followed=self.followed,
        )


def _joined(first: tuple[Contact, ...], later: tuple[Contact, ...], offset: float) -> tuple[Contact, ...]:
    known = {(contact.body, contact.phase, contact.part) for contact in first}
    return first + tuple(replace(c, time=c.time + offset) for c in later if (c.body, c.phase, c.part) not in known)


@dataclass(frozen=True, slots=True, eq=False)
class Transition(Value):
    """What an action, or a trajectory, made of a state.

    Attributes:
        state: The new state.
        motion: What happened on the way.
    """

    state: State
    motion: Motion
