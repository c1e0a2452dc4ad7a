"""What a trial's process does to itself before it begins, so that whatever happens in it stays its own."""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import signal
import sys
from multiprocessing import forkserver
from multiprocessing.connection import Connection, wait
from threading import Thread
from typing import Any

from phframe.core.process_limits import end_with_parent, limit_process


def isolate(output: Connection, memory: int) -> None:
    """Make this process one that can be ended with all that it starts, and that takes nobody down.

    It becomes the leader of a session and process group, ends when the bench does, writes to ``output`` only, leaves no
    core file, and gets an error where it asks for more memory than it may have.

    Args:
        output: Where all that is printed goes.
        memory: Address space (MB).
    """
    os.dup2(output.fileno(), 1)
    os.dup2(output.fileno(), 2)
    sys.stdout, sys.stderr = (open(fd, "w", encoding="utf-8", errors="replace", closefd=False) for fd in (1, 2))  # noqa: SIM115
    faulthandler.enable(2)
    if hasattr(os, "setsid"):
        os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _leave_fork_server()
    _die_with_the_bench()
    limit_process(RLIMIT_CORE=0, RLIMIT_AS=memory * 2**20)


def kill_group(leader: int) -> None:
    """End a process that leads a group, and all processes of that group. It may have ended already."""
    for kill in (getattr(os, "killpg", os.kill), os.kill):
        try:
            kill(leader, getattr(signal, "SIGKILL", signal.SIGTERM))
        except OSError:  # gone, or no leader yet
            continue


def _leave_fork_server() -> None:
    """Close the pipe whose open end keeps the fork server alive; whoever needs one here starts another."""
    server: Any = forkserver._forkserver
    if server._forkserver_alive_fd is not None:
        os.close(server._forkserver_alive_fd)
    server._forkserver_alive_fd = server._forkserver_address = server._forkserver_pid = None


def _die_with_the_bench() -> None:
    """Have this process killed when the bench or its fork server ends, however it ends."""
    bench = multiprocessing.parent_process()
    assert bench is not None, "a trial is a child"
    if not end_with_parent():
        Thread(target=_watch, args=(bench.sentinel,), daemon=True).start()
    if wait([bench.sentinel], 0):  # it ended before this was said
        os._exit(1)


def _watch(bench: int) -> None:
    wait([bench])
    kill_group(os.getpid())


def lift_memory_limit() -> None:
    """Have memory again, to tell that there was too little."""
    try:
        import resource
    except ImportError:
        return
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def peak_memory() -> int:
    """The most memory that this process ever had in use (bytes); 0: not known."""
    try:
        import resource
    except ImportError:
        return 0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
