"""Ctrl-C, and the end of the time, that are not lost.

Python raises KeyboardInterrupt wherever it happens to be. Inside a function that an engine written in C calls back,
such as a collision handler, the engine swallows it and goes on.
"""

from __future__ import annotations

import _thread
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import sleep
from typing import Any

_AGAIN_AFTER = 0.005  # seconds: by then the callback has usually returned, else the same happens once more
ENDING = ("SIGINT", "SIGTERM", "SIGHUP")
"""Names of the signals that end a run; what was recorded is kept."""


class EndSignals:
    """Raises at the first signal that ends a run, and not again: what there is is being saved then.

    Who wants it sooner ends the process; see ``watchdog``.

    Args:
        overdue: Called at SIGALRM, which says that the time is over; it raises where that is to end what is being done.
    """

    def __init__(self, overdue: Callable[[], None]) -> None:
        self._overdue, self._raised = overdue, False

    def install(self) -> None:
        """Listen, except to signals that are to be ignored, as under ``nohup``."""
        for name in ENDING:
            number = getattr(signal, name)
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._end)
        signal.signal(signal.SIGALRM, lambda number, frame: self._overdue())

    def again(self) -> None:
        """Raise at the next one: the last was swallowed."""
        self._raised = False

    def _end(self, number: int, frame: object) -> None:
        if not self._raised:
            self._raised = True
            raise KeyboardInterrupt


@contextmanager
def dependable_interrupts(
    again: Callable[[], None] = lambda: None, overdue: type[Exception] | tuple[()] = ()
) -> Iterator[None]:
    """Have a KeyboardInterrupt that was swallowed raised again, until it gets through.

    Args:
        again: Is told before it is.
        overdue: The exception of SIGALRM, for which the same holds.
    """
    before = sys.unraisablehook

    def raise_again(swallowed: Any) -> None:
        if issubclass(swallowed.exc_type, KeyboardInterrupt):
            number = signal.SIGINT
        elif issubclass(swallowed.exc_type, overdue):
            number = signal.SIGALRM
        else:
            before(swallowed)
            return
        while True:
            try:
                again()
                _thread.start_new_thread(_interrupt_again, (number,))
            except KeyboardInterrupt:  # on a busy machine the last one may come while this still runs: once more
                continue
            return

    sys.unraisablehook = raise_again
    try:
        yield
    finally:
        sys.unraisablehook = before


def _interrupt_again(number: signal.Signals) -> None:
    sleep(_AGAIN_AFTER)
    _thread.interrupt_main(number)
