"""What a motion planner may spend on one path: counted iterations decide, the clock only ends hopeless runs."""

from __future__ import annotations

import time


class Budget:
    """Iterations of a search and the time allowed for it all; made for one path, spent and dropped.

    Once anyone was stopped by the clock, ``timed_out`` stays True: what was found then depends on how busy the machine
    is, and must not be used.

    Args:
        iterations: Of the sampling-based planner, in all.
        seconds: From now on.

    Attributes:
        iterations: Those that are left.
        timed_out: Whether anyone was stopped by the clock.
    """

    def __init__(self, iterations: int, seconds: float) -> None:
        self.iterations, self.timed_out = iterations, False
        self._end = time.monotonic() + seconds

    def expired(self) -> bool:
        """Whether the time is up; whoever asks must stop if so."""
        self.timed_out = self.timed_out or time.monotonic() > self._end
        return self.timed_out

    def spent(self) -> bool:
        """Spend one iteration; True where none is left, or no time."""
        self.iterations -= 1
        return self.iterations < 0 or self.expired()
