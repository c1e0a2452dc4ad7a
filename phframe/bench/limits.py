"""What a trial may take."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TrialLimits:
    """What a trial may take. Its process is ended where it takes more.

    Attributes:
        seconds: Wall time of the whole trial, loading and execution included.
        memory: Address space of its process, and of each that it starts (MB).
    """

    seconds: float
    memory: int
