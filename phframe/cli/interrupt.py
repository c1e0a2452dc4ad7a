"""Ctrl-C, and the end of the time, that are not lost.

Python raises KeyboardInterrupt wherever it happens to be. Inside a function that an engine written in C calls back,
such as a collision handler, the engine swallows it and goes on.
"""

from __future__ import annotations

import _thread
import atexit
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import inf
from time import monotonic, sleep
from typing import Any

_AGAIN_AFTER = 0.005  # seconds: by then the callback has usually returned, else the same happens once more
ENDING = ("SIGINT", "SIGTERM", "SIGHUP")
"""Names of the signals that end a run; what was recorded is kept."""


class EndSignals:
    """Raises KeyboardInterrupt at the first signal that ends a command, and not again while what there is is being saved.

    Args:
        patience: After this a signal raises once more (s); infinite where somebody else ends the process, as a watchdog does.
    """

    def __init__(self, patience: float = inf) -> None:
        self._patience, self._deaf_until = patience, 0.0
        self._act: Callable[[], None] = _interrupt

    def install(self) -> None:
        """Listen, except to signals that are to be ignored, as under ``nohup``."""
        for number in _heard():
            signal.signal(number, self._end)
        atexit.register(_ignore)  # what comes while the interpreter is taken apart would end it otherwise

    def again(self) -> None:
        """Raise at the next one: the last was swallowed."""
        self._deaf_until = 0.0

    def over(self) -> None:
        """Raise no more: all is done and told."""
        self._deaf_until = inf

    def at_exit(self, act: Callable[[], None]) -> None:
        """Raise no more, and do something else at a signal that comes later: all is done, and the process is about to end."""
        self._deaf_until, self._act = monotonic() + self._patience, act

    def _end(self, number: int, frame: object) -> None:
        if (now := monotonic()) >= self._deaf_until:
            self._deaf_until = now + self._patience
            self._act()


def _interrupt() -> None:
    raise KeyboardInterrupt


def _heard() -> list[int]:
    """The signals that end a command here."""
    numbers = [int(getattr(signal, name)) for name in ENDING if hasattr(signal, name)]
    return [number for number in numbers if signal.getsignal(number) is not signal.SIG_IGN]


def _ignore() -> None:
    for number in _heard():
        signal.signal(number, signal.SIG_IGN)


@contextmanager
def signals_held_back() -> Iterator[None]:
    """Meanwhile signals that end a command wait, unless somebody lets them through; where the system can do so."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _heard())
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def let_signals_through() -> None:
    """Have those come that were held back."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [getattr(signal, name) for name in ENDING])


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
