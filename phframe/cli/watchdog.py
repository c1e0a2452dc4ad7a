"""Watches a command that runs in a child process: it is ended where it takes more than it may, and its end is told.

Nothing that the child imports or does reaches this process. What it leaves when it is killed, or dies, is brought in
order: the episode on the disk says why it got no farther, and no temporary file stays. Needs ``fork``; imports nothing heavy.
"""

from __future__ import annotations

import glob
import json
import os
import select
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from phframe.cli.console import note
from phframe.cli.exit_codes import ExitCode
from phframe.cli.interrupt import ENDING, let_signals_through
from phframe.cli.processes import descendants, memory_of

GRACE = 2.0
"""After its time, for what ends by itself, such as a simulation that was begun before (s)."""
LAST_GRACE = 3.0
"""After it was told that the time is over, before it is killed (s)."""
TO_SAVE = {signal.SIGINT: None, signal.SIGTERM: 10.0, getattr(signal, "SIGHUP", signal.SIGTERM): 10.0}
"""How long it may take to save what there is, after a signal (s); None: until the next one."""
TO_SAVE_AT_ONCE = 0.5
"""The same, from the first signal on, once there is a second."""
TO_EXIT = 10.0
"""For the interpreter to end when all is done (s)."""
LOOK = 0.2
"""How often its memory is looked at (s)."""
EPISODE = "episode.json"
UNFINISHED = "unfinished"
"""How the reason of an episode begins that was still running when it was written."""


@dataclass(frozen=True, slots=True)
class Death:
    """Why there is no result.

    Attributes:
        status: Of the episode, as far as it got.
        reason: In words.
        code: Of the command.
    """

    status: str
    reason: str
    code: int


_UNEXPLAINED = Death("failed", "", ExitCode.OTHER_OUTCOME)


class Watchdog:
    """Waits for one child.

    Args:
        child: Its process id.
        reader: The end of the pipe that it reports to, line by line, as JSON.
        memory: That it and what it starts may have in use (MB); None: any.
    """

    def __init__(self, child: int, reader: int, memory: int | None) -> None:
        self._child, self._reader, self._memory = child, reader, memory
        self._report, self._open = b"", True
        self._code: int | None = None
        self._folder: Path | None = None
        self._videos: list[Path] = []
        self._limit, self._what, self._overdue_at = 0.0, "", float("inf")
        self._kill_at, self._death = float("inf"), _UNEXPLAINED
        self._signals: list[int] = []
        self._first_signal = 0.0

    def wait(self) -> int:
        """Until it has ended, whatever it takes; the exit code of the command."""
        with _signals() as woken:
            while (status := self._ended()) is None:
                ready, _, _ = select.select([woken, *([self._reader] if self._open else [])], [], [], self._patience())
                if woken in ready:
                    for number in os.read(woken, 64):
                        self._signalled(number)
                if self._reader in ready:
                    self._listen()
                self._enforce()
            while self._listen():
                pass
            return self._told(status)

    def _ended(self) -> int | None:
        try:
            pid, status = os.waitpid(self._child, os.WNOHANG)
        except ChildProcessError:  # somebody else has waited for it, as the kernel does where SIGCHLD is ignored
            return 0
        return None if pid == 0 else os.waitstatus_to_exitcode(status)

    def _patience(self) -> float:
        until = min(self._overdue_at, self._kill_at) - time.monotonic()
        return max(0.0, min(until, LOOK if self._memory else 3600.0))

    def _listen(self) -> bool:
        """Take in what it reports; whether there was anything."""
        try:
            piece = os.read(self._reader, 65536)
        except BlockingIOError:
            return False
        *lines, self._report = (self._report + piece).split(b"\n")
        for line in lines:
            with suppress(ValueError, TypeError, AttributeError):
                self._take(json.loads(line))
        self._open = bool(piece)
        return self._open

    def _take(self, report: dict[str, Any]) -> None:
        if "folder" in report:
            self._folder = Path(report["folder"])
        if "video" in report:
            self._videos.append(Path(report["video"]))
        if "limit" in report:
            self._set_limit(report["limit"], str(report.get("what", "")))
        if "ended" in report:
            self._code, self._overdue_at = int(report["ended"]), float("inf")
            self._kill_at = time.monotonic() + TO_EXIT

    def _set_limit(self, seconds: float | None, what: str) -> None:
        if self._signals:  # it is to end: how long it may take was said then
            return
        if self._overdue_at == float("inf"):  # it was told that the time is over, and went on to save what there is
            self._kill_at, self._death = float("inf"), _UNEXPLAINED
        self._limit, self._what = seconds or 0.0, what
        self._overdue_at = float("inf") if seconds is None else time.monotonic() + float(seconds) + GRACE

    def _signalled(self, number: int) -> None:
        if number == signal.SIGCHLD:
            return
        now = time.monotonic()
        self._first_signal = self._first_signal or now
        self._signals.append(number)
        self._overdue_at = float("inf")
        self._send(number)
        patience = TO_SAVE.get(signal.Signals(number))
        if len(self._signals) > 1:
            self._kill_at = min(self._kill_at, max(now, self._first_signal + TO_SAVE_AT_ONCE))
        elif patience is not None:
            self._kill_at = now + patience

    def _enforce(self) -> None:
        now = time.monotonic()
        if now >= self._overdue_at:
            self._overdue_at, self._kill_at = float("inf"), min(self._kill_at, now + LAST_GRACE)
            reason = f"{self._what} took longer than {self._limit:g} s and was stopped"
            self._death = Death("timeout", reason, ExitCode.OTHER_OUTCOME)
            self._send(signal.SIGALRM)
        if now >= self._kill_at:
            self._kill()
        elif self._memory and memory_of(self._child) > self._memory * 2**20:
            reason = f"it used more than the {self._memory} MB of memory that it may have"
            self._death = Death("failed", reason, ExitCode.OTHER_OUTCOME)
            self._kill()

    def _send(self, number: int) -> None:
        with suppress(ProcessLookupError):
            os.kill(self._child, number)

    def _kill(self) -> None:
        """End it and what it has started."""
        self._kill_at, self._memory = float("inf"), None
        for each in (self._child, *descendants(self._child)):
            with suppress(OSError):
                os.kill(each, signal.SIGKILL)

    def _told(self, status: int) -> int:
        """Bring in order what it left, and say so, unless it ended as it should."""
        if self._code is not None:
            return self._code
        death = self._death
        if self._signals:
            death = Death("failed", "interrupted by Ctrl-C", ExitCode.INTERRUPTED)
        elif not death.reason:
            death = Death("failed", f"its process {_exit(status)} before there was a result", ExitCode.OTHER_OUTCOME)
        kept = self._finish(death)
        where = f"what was recorded is in {self._folder}" if kept else "nothing was recorded yet"
        if sys.stderr.isatty():
            sys.stderr.write("\r\x1b[2K\x1b[?25h")  # the line of what was going on is still there, the cursor is not
        note(f"interrupted; {where}" if self._signals else f"error: {death.reason}; {where}")
        return death.code

    def _finish(self, death: Death) -> bool:
        """Have the episode on the disk say how it ended; whether there is one."""
        for video in self._videos:
            _sweep(video.parent, f".{glob.escape(video.name[:40])}.*.part")
        if self._folder is None:
            return False
        _sweep(self._folder, ".*.part")
        place, part = self._folder / EPISODE, self._folder / f".{EPISODE}.part"
        try:
            document = json.loads(place.read_text(encoding="utf-8"))
            if not document["episode"]["reason"].startswith(UNFINISHED):  # it was over, and has been judged
                return True
            document["episode"] |= {"status": death.status, "reason": death.reason}
            part.write_text(json.dumps(document), encoding="utf-8")
            part.replace(place)
        except (OSError, ValueError, KeyError, TypeError):
            with suppress(OSError):
                part.unlink()
            return place.exists()
        return True


def _sweep(folder: Path, pattern: str) -> None:
    for part in folder.glob(pattern):
        with suppress(OSError):
            part.unlink()


def _exit(code: int) -> str:
    if code >= 0:
        return f"ended with exit code {code}"
    return f"was ended by signal {-code} ({signal.strsignal(-code) or 'unknown'})"


@contextmanager
def _signals() -> Iterator[int]:
    """The end of a pipe that gives the number of every signal that comes, but for those that are to be ignored.

    Afterwards all are: nothing is left to be ended but this process, which does.
    """
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    for name in (*ENDING, "SIGCHLD"):
        if signal.getsignal(number := getattr(signal, name)) is not signal.SIG_IGN:
            signal.signal(number, lambda number, frame: None)
    signal.set_wakeup_fd(writer)
    let_signals_through()
    try:
        yield reader
    finally:
        for name in ENDING:
            signal.signal(getattr(signal, name), signal.SIG_IGN)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        signal.set_wakeup_fd(-1)
        os.close(reader)
        os.close(writer)
