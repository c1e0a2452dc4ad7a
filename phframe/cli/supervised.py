"""Has a command carried out in a child process, with a watchdog beside it that what runs in there cannot reach."""

from __future__ import annotations

import atexit
import json
import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

import typer

from phframe.cli.console import note
from phframe.cli.exit_codes import ExitCode
from phframe.cli.failures import report
from phframe.cli.interrupt import EndSignals, dependable_interrupts, let_signals_through, signals_held_back

SUPERVISED = "supervised"
"""Object of the top context where a command is a process of its own, so that it may fork."""
LOADING = 300.0
"""For what comes before planning: finding the parts, building the worlds, choosing where an arm stands (s)."""


class WatchdogLink:
    """What the child tells the watchdog. Without one nobody is told.

    Args:
        writer: The end of the pipe to write to; None: there is no watchdog.
    """

    def __init__(self, writer: int | None = None) -> None:
        self._writer, self._limited = writer, False
        self._place: Path | None = None
        self.signals = EndSignals()

    def limit(self, seconds: float | None, what: str = "") -> None:
        """Say how long what begins now may take; None: as long as it likes."""
        self._limited = seconds is not None
        self._tell({"limit": seconds, "what": what})

    def folder(self, path: Path) -> None:
        """Say where the files of the run are."""
        self._place = path
        self._tell({"folder": str(path)})

    def video(self, path: Path) -> None:
        """Say which video is being made."""
        self._tell({"video": str(path.resolve())})

    @property
    def interruption(self) -> str:
        """What is said of a run that is interrupted."""
        from phframe.cli.watchdog import EPISODE

        kept = self._place is not None and (self._place / EPISODE).exists()
        return f"interrupted; {f'what was recorded is in {self._place}' if kept else 'nothing was recorded yet'}"

    def listen(self) -> None:
        """Have signals raise what they are to raise: to end, and that the time is over."""
        self.signals.install()
        signal.signal(signal.SIGALRM, lambda number, frame: self._overdue())
        let_signals_through()

    def ended(self, code: int) -> None:
        """Say that all is done and told, and how it went."""
        self._limited = False
        self._tell({"ended": int(code)})

    def _tell(self, what: dict[str, Any]) -> None:
        if self._writer is not None:
            with suppress(OSError):
                os.write(self._writer, json.dumps(what).encode() + b"\n")

    def _overdue(self) -> None:
        if self._limited:
            self._limited = False
            from phframe.core.errors import OverdueError

            raise OverdueError


def supervised(context: typer.Context, work: Callable[[WatchdogLink], int], memory: int | None = None) -> int:
    """Do something in a child process under a watchdog, where the command runs on its own and the system can fork.

    Args:
        context: Of the command.
        work: What is done; it is given what the watchdog is told by, and returns the exit code.
        memory: That it may have in use (MB); None: any.

    Returns:
        The exit code.
    """
    if context.find_root().obj is not SUPERVISED or not hasattr(os, "fork"):
        return work(WatchdogLink())
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    with signals_held_back():  # until both processes are ready for them
        parent = os.getpid()
        try:
            reader, writer = os.pipe()
            child = os.fork()
        except OSError:  # no process is to be had: without a watchdog, then
            child = None
        if child == 0:
            os.close(reader)
            _carry_out(work, WatchdogLink(writer), parent)
        if child is not None:
            from phframe.cli.watchdog import Watchdog

            os.close(writer)
            os.set_blocking(reader, False)
            return Watchdog(child, reader, memory).wait()
    return work(WatchdogLink())


def _carry_out(work: Callable[[WatchdogLink], int], link: WatchdogLink, parent: int) -> NoReturn:
    """Do it, in the child, and end it: taking apart what it has imported would take ten times as long as forking did."""
    _end_with(parent)
    link.limit(LOADING, "loading")
    code = _code_of(work, link)
    link.ended(code)
    try:
        atexit._run_exitfuncs()
    finally:
        os._exit(code)


def _code_of(work: Callable[[WatchdogLink], int], link: WatchdogLink) -> int:
    """What the command ends with, its errors told."""
    try:
        return _done(work, link)
    except (KeyboardInterrupt, typer.Abort):
        note(link.interruption)
        return ExitCode.INTERRUPTED
    except typer.Exit as error:
        return error.exit_code
    except Exception as error:  # noqa: BLE001 - nobody is to see a traceback
        return report(error)
    finally:
        if sys.stdout is not None:
            with suppress(OSError, ValueError):
                sys.stdout.flush()


def _done(work: Callable[[WatchdogLink], int], link: WatchdogLink) -> int:
    """What it returns; signals raise nothing before it, and nothing after it."""
    from phframe.core.errors import OverdueError  # not for the watchdog

    try:
        link.listen()
        with dependable_interrupts(link.signals.again, OverdueError):
            return work(link)
    finally:
        link.signals.over()


def _end_with(parent: int) -> None:
    """Have this process killed when the watchdog is, so that nothing runs on unwatched; what it has written stays."""
    from phframe.core.process_limits import end_with_parent

    if end_with_parent() and os.getppid() != parent:
        os._exit(1)
