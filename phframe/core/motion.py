"""What executing a trajectory did."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core.gripper_path import Phase
from phframe.core.state import State
from phframe.core.value import Value


@dataclass(frozen=True, slots=True)
class Contact:
    """The first time the arm touched something.

    Attributes:
        time: Seconds from the start of the motion.
        body: The object's id, or ``south wall``, ``north wall``, ``back wall``, ``ceiling``, ``board``.
        phase: What the arm was doing.
    """

    time: float
    body: str
    phase: Phase


@dataclass(frozen=True, slots=True)
class Motion:
    """What executing a trajectory did.

    Attributes:
        duration: Simulated or real time it took, settling included (s).
        contacts: First contact of the arm with each object, in order of time.
        wall_contacts: First contact of the arm with each wall, in order of time.
        largest_force: The largest contact force on the arm (N).
        stalled: Whether the force limit kept the arm from going on. It then stands where it stalled.
        stopped: Why the motion ended early (which stop condition), or None.
        tracking_error: Largest distance between where the fingertip was meant to be and where it was (m).
        settled: Whether everything came to rest in the time allowed.
    """

    duration: float
    contacts: tuple[Contact, ...] = ()
    wall_contacts: tuple[Contact, ...] = ()
    largest_force: float = 0.0
    stalled: bool = False
    stopped: str | None = None
    tracking_error: float = 0.0
    settled: bool = True

    @property
    def complete(self) -> bool:
        """Whether the trajectory was followed to its end."""
        return not self.stalled and self.stopped is None

    def then(self, later: Motion) -> Motion:
        """This motion and a later one as one: what went wrong in either is kept, times run on."""
        return Motion(
            duration=self.duration + later.duration,
            contacts=_joined(self.contacts, later.contacts, self.duration),
            wall_contacts=_joined(self.wall_contacts, later.wall_contacts, self.duration),
            largest_force=max(self.largest_force, later.largest_force),
            stalled=self.stalled or later.stalled,
            stopped=self.stopped or later.stopped,
            tracking_error=max(self.tracking_error, later.tracking_error),
            settled=later.settled,
        )


def _joined(first: tuple[Contact, ...], later: tuple[Contact, ...], offset: float) -> tuple[Contact, ...]:
    known = {contact.body for contact in first}
    return first + tuple(Contact(c.time + offset, c.body, c.phase) for c in later if c.body not in known)


@dataclass(frozen=True, slots=True, eq=False)
class Transition(Value):
    """What an action, or a trajectory, made of a state.

    Attributes:
        state: The new state.
        motion: What happened on the way.
    """

    state: State
    motion: Motion
