"""PyBullet without what its C++ code writes to the process's own output, where a program's results belong."""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

STREAMS = (1, 2)
"""File descriptors of standard output and standard error."""


@contextmanager
def caught_output() -> Iterator[list[str]]:
    """Collects what C code of this process writes in this block, by line; filled in as the block ends."""
    found: list[str] = []
    with tempfile.TemporaryFile() as caught, ExitStack() as stack:
        _flush()
        kept = [(stream, copy) for stream in STREAMS if (copy := _copy(stream)) is not None]
        stack.callback(lambda: found.extend(_lines(caught.fileno())))
        for stream, copy in kept:
            stack.callback(os.close, copy)
            stack.callback(os.dup2, copy, stream)
            os.dup2(caught.fileno(), stream)
        stack.callback(_flush)
        yield found


def _copy(stream: int) -> int | None:
    try:
        return os.dup(stream)
    except OSError:  # closed, as it may be in a process without a terminal
        return None


def _lines(descriptor: int) -> list[str]:
    os.lseek(descriptor, 0, os.SEEK_SET)
    text = b"".join(iter(lambda: os.read(descriptor, 65536), b""))
    return [line for line in text.decode(errors="replace").splitlines() if line.strip()]


def _flush() -> None:
    """Write out what Python and C have kept back, so that it goes where it was meant to go."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None and not stream.closed:
            stream.flush()
    if os.name == "posix":  # elsewhere there is no library that stands for the process itself
        ctypes.CDLL(None).fflush(None)


with caught_output():
    import pybullet as bullet  # greets on import

__all__ = ["bullet", "caught_output"]
