"""What a motion planner may spend on one path: counted iterations decide, the clock only ends hopeless runs."""

from __future__ import annotations

import time
from collections.abc import Callable


class SearchBudget:
    """Iterations of a search and the time allowed for it all; made for one path, spent and dropped.

    Once anyone was stopped by the clock, ``timed_out`` stays True: what was found then depends on how busy the machine
    is, and must not be used.

    Args:
        iterations: Of the sampling-based planner, in all that it searches.
        seconds: From now on.

    Attributes:
        timed_out: Whether anyone was stopped by the clock.
    """

    def __init__(self, iterations: int, seconds: float) -> None:
        self.timed_out = False
        self._left, self._end = iterations, time.monotonic() + seconds

    def expired(self) -> bool:
        """Whether the time is up; whoever asks must stop if so."""
        self.timed_out = self.timed_out or time.monotonic() > self._end
        return self.timed_out

    def search(self) -> Callable[[], bool]:
        """Asked once in each of its iterations, ends a search after half of those left, so that another may follow."""
        least = self._left // 2

        def stop() -> bool:
            if self._left <= least:
                return True
            self._left -= 1
            return self.expired()

        return stop
