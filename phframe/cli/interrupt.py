"""Ctrl-C that is not lost.

Python raises KeyboardInterrupt wherever it happens to be. Inside a function that an engine written in C calls back,
such as a collision handler, the engine swallows it and goes on.
"""

from __future__ import annotations

import _thread
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from time import sleep
from typing import Any

_AGAIN_AFTER = 0.005  # seconds: by then the callback has usually returned, else the same happens once more


@contextmanager
def dependable_interrupts() -> Iterator[None]:
    """Have a KeyboardInterrupt that was swallowed raised again, until it gets through."""
    before = sys.unraisablehook

    def raise_again(swallowed: Any) -> None:
        if not issubclass(swallowed.exc_type, KeyboardInterrupt):
            before(swallowed)
            return
        while True:
            try:
                _thread.start_new_thread(_interrupt_again, ())
            except KeyboardInterrupt:  # on a busy machine the last one may come while this still runs: once more
                continue
            return

    sys.unraisablehook = raise_again
    try:
        yield
    finally:
        sys.unraisablehook = before


def _interrupt_again() -> None:
    sleep(_AGAIN_AFTER)
    _thread.interrupt_main()
