"""A trial in a process of its own, as the bench sees it: it is started, listened to, and ended."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

from phframe.bench.child import main
from phframe.bench.environment import Environment
from phframe.bench.isolation import kill_group
from phframe.bench.limits import TrialLimits
from phframe.bench.trial import Trial
from phframe.core import InputError

LARGEST_RESULT = 2**20
"""Bytes; a trial that sends more is not listened to."""
TAIL = 8192
"""Bytes that are kept of what a trial prints: the last ones."""
METHOD = "forkserver"
"""How processes are made: from one that has imported already, and nothing else: no thread, no open database."""
_LONGEST_WAIT = 3600.0
"""Seconds; systems can wait for so long at a time."""
_READS, _PIECE = 32, 65536
"""Reads at a time, and bytes of each."""
_THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)
"""Environment variables that are 1 in trials: they run beside one another."""


@dataclass(frozen=True, slots=True)
class Ending:
    """How the process of a trial ended.

    Attributes:
        code: Its exit code; negative: the signal that ended it.
        overdue: Whether it was killed for the time it took.
        message: What it sent.
        output: The last that it printed.
        wall_time: How long it ran (s).
        started: When, in UTC, ISO 8601.
        environment: Where it ran; None: where the bench does.
    """

    code: int
    overdue: bool
    message: bytes
    output: str
    wall_time: float
    started: str
    environment: Environment | None = None


class TrialProcess:
    """One trial in a process of its own. Nothing runs before ``start``.

    Args:
        trial: The trial.
        limits: At which its process is ended.
    """

    def __init__(self, trial: Trial, limits: TrialLimits) -> None:
        self.trial, self._limits = trial, limits
        self._context: Any = multiprocessing.get_context(METHOD)
        self._process: Any = None
        self._pipes: list[PipeTail] = []
        self._overdue = False
        self._began, self._started = 0.0, ""

    def start(self) -> None:
        """Start it.

        Raises:
            InputError: If the system gives no process.
        """
        (results, send), (output, write) = (self._context.Pipe(duplex=False) for _ in range(2))
        self._pipes = [PipeTail(results, LARGEST_RESULT), PipeTail(output, TAIL)]
        self._process = self._context.Process(
            target=main, args=(self.trial.spec, self._limits.memory, send, write), daemon=False
        )
        self._began, self._started = time.monotonic(), time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        try:
            with one_thread_each():
                self._process.start()
        except (OSError, EOFError) as error:
            remedy = " Set TMPDIR to a directory with a shorter path." if "AF_UNIX" in str(error) else ""
            raise InputError(f"cannot start the process of a trial: {_why(error)}.{remedy}") from None
        finally:
            send.close()
            write.close()

    @property
    def waitables(self) -> list[Any]:
        """What is ready when there is something to do: the process's end, or what it wrote."""
        return [self._process.sentinel, *(pipe.reader for pipe in self._pipes if not pipe.at_end)]

    @property
    def seconds_left(self) -> float:
        """Until it is overdue; an hour if that is farther away: then it is to be listened to anyway."""
        return min(max(0.0, self._began + self._limits.seconds - time.monotonic()), _LONGEST_WAIT)

    def listen(self) -> bool:
        """Take in what it wrote, kill it if it is overdue, and say whether it has ended."""
        ended = bool(wait([self._process.sentinel], 0))
        for pipe in self._pipes:
            pipe.read()
        if not ended and not self.seconds_left and not self._overdue:
            self._overdue = True
            kill_group(self._process.pid)
        return ended

    def ending(self) -> Ending:
        """How it ended; whatever it has started ends now."""
        wall_time = time.monotonic() - self._began
        self._process.join()
        message, output = (bytes(pipe.kept) for pipe in self._pipes)
        self.end()
        code = self._process.exitcode
        self._process.close()
        text = output.decode(errors="replace")
        return Ending(code, self._overdue, message, text, wall_time, self._started)

    def end(self) -> None:
        """End it and all that it has started, and listen no more. May be called at any time."""
        if self._process is not None and self._process.pid is not None:
            kill_group(self._process.pid)
        for pipe in self._pipes:
            pipe.reader.close()
        self._pipes = []


class PipeTail:
    """What comes out of a pipe: read without waiting, of which the last bytes are kept.

    Args:
        reader: The end to read from.
        most: How many bytes are kept.

    Attributes:
        kept: These.
        at_end: Whether nothing more will come.
    """

    def __init__(self, reader: Connection, most: int) -> None:
        self.reader, self._most = reader, most
        self.kept = bytearray()
        self.at_end = False
        os.set_blocking(reader.fileno(), False)

    def read(self) -> None:
        """Take in what is there now; of what comes without end, a part."""
        for _ in range(_READS):
            try:
                piece = os.read(self.reader.fileno(), _PIECE)
            except BlockingIOError:
                return
            if not piece:
                self.at_end = True
                return
            self.kept += piece
            del self.kept[: -self._most]


def _why(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error) or "the process that they are forked from has ended"


def preload(modules: Iterable[str]) -> None:
    """Say what the processes of trials have imported from the beginning; before the first of them.

    Args:
        modules: Their names; what every trial needs is imported anyway.
    """
    multiprocessing.set_forkserver_preload(["__main__", *modules, "phframe.bench.preload"])


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Have the processes started meanwhile use one thread each for numerical work."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
