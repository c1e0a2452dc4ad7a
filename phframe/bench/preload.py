"""The last that the fork server imports: readies it for the trials that it forks, and sees that nothing outlives it.

When the bench ends, however it does, its fork server comes to an end in the usual way of Python. Trials die with their
server; what they have started themselves is killed here before that.
"""

from __future__ import annotations

import atexit
import gc
import os
from pathlib import Path

import phframe.bench.child  # noqa: F401 - all that a trial needs whatever it runs
from phframe.registry import builtins, versions
from phframe.runtime.scenes import find_scene

_SERVER = os.getpid()
_PARENT, _GROUP = 1, 2
"""Fields of a process's line after its name."""


def end_children() -> None:
    """Kill the group of every process that this one has forked, if it leads one. Where there is no ``/proc``: nothing."""
    if os.getpid() != _SERVER:
        return
    from phframe.bench.isolation import kill_group

    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
        except OSError:  # it has ended
            continue
        if int(fields[_PARENT]) == _SERVER and fields[_GROUP] == status.parent.name:
            kill_group(int(fields[_GROUP]))


def warm_up() -> None:
    """Find out what every trial would find out anew, and have the garbage collector leave all of it alone."""
    find_scene("vieira/basic")  # imports what reads scenes
    versions((entry.extension.kind, entry.name) for entry in builtins().entries)
    gc.collect()
    gc.freeze()


atexit.register(end_children)
atexit.register(gc.unfreeze)  # else OMPL's bindings take what was never collected for leaked, and say so
warm_up()
