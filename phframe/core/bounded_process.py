"""Work on what strangers wrote, in a process of its own: it is ended where it takes too much memory or time.

Libraries that parse files for robots and meshes trust them: a few lines can ask for more memory than there is, wait for
ever, or end the process. What such a process answers is bytes and never a pickle, since those can run code.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from phframe.core.errors import PhframeError
from phframe.core.process_limits import limit_process

OUT_OF_MEMORY = 88
"""Exit code of a process that may not have as much memory as it wants."""
GRACE = 5
"""A process whose parent is gone ends itself so long after its time (s)."""


@dataclass(frozen=True, slots=True)
class ProcessLimits:
    """What a process may take.

    Attributes:
        memory: Address space besides what its libraries have when it begins (MB). Windows and macOS do not limit it.
        seconds: Wall time, the start included.
    """

    memory: int = 2000
    seconds: float = 60.0


class ProcessEndedError(PhframeError):
    """A process that ended, or was ended, before it had an answer; says why."""


def answer_of(module: str, question: bytes, limits: ProcessLimits) -> bytes:
    """What a module answers that is run in a process of its own, where it calls ``answer``.

    Nothing that it prints is seen, and it ends with the caller's interruption. The current directory is not searched for
    modules.

    Args:
        module: Its name.
        question: For its function.
        limits: What the process may take.

    Raises:
        ProcessEndedError: If it cannot be started, took more than it may, or ended without an answer.
    """
    command = [sys.executable, "-P", "-m", module, str(limits.memory), str(limits.seconds)]
    with _started(command) as process:
        try:
            found, _ = process.communicate(question, timeout=limits.seconds)
        except subprocess.TimeoutExpired:
            raise ProcessEndedError(f"it takes more than {limits.seconds:g} s") from None
        finally:
            process.kill()
    if process.returncode != 0:
        raise ProcessEndedError(_why(process.returncode, limits))
    return found


def _started(command: list[str]) -> subprocess.Popen[bytes]:
    pipe, nowhere = subprocess.PIPE, subprocess.DEVNULL
    try:
        return subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=nowhere)
    except OSError as error:
        raise ProcessEndedError(f"no process for it can be started: {error.strerror or error}") from None


def answer(work: Callable[[bytes], bytes]) -> None:
    """The whole of what a process does that ``answer_of`` started: limits itself, works, answers.

    Args:
        work: From the question to the answer.
    """
    memory, seconds = sys.argv[1:]
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # also while a library is at work that never returns to Python
    into = os.dup(1)
    os.dup2(2, 1)  # what libraries print is no answer
    _limit(int(memory), float(seconds))
    try:
        found = work(sys.stdin.buffer.read())
        with os.fdopen(into, "wb") as stream:
            stream.write(found)
    except MemoryError:
        os._exit(OUT_OF_MEMORY)


def _limit(memory: int, seconds: float) -> None:
    """Limit this process; it leaves no file and no core, and ends in time though nobody is there to end it."""
    if hasattr(signal, "alarm"):
        signal.alarm(math.ceil(seconds) + GRACE)
    limit_process(RLIMIT_CORE=0, RLIMIT_FSIZE=0, RLIMIT_AS=_address_space() + memory * 2**20)


def _address_space() -> int:
    """What this process has now (bytes); 0 where the system does not tell."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except OSError:
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")


def _why(code: int, limits: ProcessLimits) -> str:
    if code == OUT_OF_MEMORY:
        return f"it takes more than {limits.memory} MB"
    if code > 0:
        return f"the process that reads it ended with exit code {code}"
    with suppress(ValueError):
        return (
            f"the process that reads it, which may take {limits.memory} MB, was ended by {signal.Signals(-code).name}"
        )
    return f"the process that reads it was ended by signal {-code}"
