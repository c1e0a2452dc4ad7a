"""What a process has started, and the memory that it has in use, where the system says so (``/proc``)."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

_RESIDENT = 1
"""Field of ``statm``, in pages."""


def descendants(process: int) -> list[int]:
    """The processes that one has started, and those that they have; none where the system does not say."""
    found: list[int] = []
    for child in _children(process):
        found += [child, *descendants(child)]
    return found


def memory_of(process: int) -> int:
    """What a process and all that it has started have in use (bytes); 0: not known."""
    return sum(map(_resident, (process, *descendants(process))))


def _children(process: int) -> Iterator[int]:
    for thread in Path(f"/proc/{process}/task").glob("*/children"):
        try:
            yield from map(int, thread.read_text(encoding="ascii").split())
        except (OSError, ValueError):  # it has ended
            continue


def _resident(process: int) -> int:
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text(encoding="ascii").split()[_RESIDENT])
        return pages * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):
        return 0
