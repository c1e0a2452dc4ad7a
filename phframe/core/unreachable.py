"""A path that an arm cannot follow."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Unreachable:
    """A path that an arm cannot follow.

    Attributes:
        where: How far along the path it gets (m).
        why: The joint limit, the collision and with what, or the missing inverse.
        leg: Index of the path's leg on which it ends.
        bodies: What is collided with, if anything.
        timed_out: Whether the time allowed ran out before all was tried; what does not repeat.
    """

    where: float
    why: str
    leg: int | None = None
    bodies: tuple[str, ...] = ()
    timed_out: bool = False
