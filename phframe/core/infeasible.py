"""A result that says no."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Infeasible:
    """What cannot be done, as a result rather than an exception.

    Attributes:
        reason: Why, for people.
        blockers: Ids of the obstructing objects, if objects are.
    """

    reason: str
    blockers: tuple[str, ...] = ()
