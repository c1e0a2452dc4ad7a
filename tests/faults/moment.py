"""Runs phframe, and at the n-th call of a function in one of its processes has signals sent to it.

``moment.py NOTE PROCESS AFTER NUMBER SIGNALS ARGUMENT...``; see ``Moment``. What is counted are calls and returns of
functions, of Python and of C, in the main thread: events, not seconds.
"""

from __future__ import annotations

import os
import runpy
import sys
import time
from pathlib import Path
from typing import Any

TOP, CHILD = range(2)
"""The process that is started, and the one that it forks."""
SPAN = 0.004
"""Between two signals of several: five within 20 ms (s)."""


class Moment:
    """Counts the events of a process or, where it forks, of its child; at one of them signals are sent to the former.

    Args:
        note: The file that is made as they are sent.
        process: Whose events are counted.
        after: The name of the function from whose first call on they are; empty: from the beginning.
        number: At which event the signals are sent, from 1.
        signals: What is sent.
    """

    def __init__(self, note: Path, process: int, after: str, number: int, signals: list[int]) -> None:
        self._note, self._process, self._after, self._left, self._signals = note, process, after, number, signals
        self._top = os.getpid()

    def wait(self) -> None:
        """Begin to count."""
        os.register_at_fork(after_in_child=self._forked)
        if self._process == TOP:
            self._begin()

    def _begin(self) -> None:
        sys.setprofile(self._look_for_the_call if self._after else self._count)

    def _forked(self) -> None:
        self._process -= 1
        if self._process == TOP:
            self._begin()
        else:
            sys.setprofile(None)

    def _look_for_the_call(self, frame: Any, event: str, argument: Any) -> None:
        if event == "call" and frame.f_code.co_name == self._after:
            sys.setprofile(self._count)

    def _count(self, frame: Any, event: str, argument: Any) -> None:
        self._left -= 1
        if not self._left:
            sys.setprofile(None)
            self._note.touch()
            self._send()

    def _send(self) -> None:
        """The first at once, the others, a little apart, from a process that is nobody's child."""
        first, *more = self._signals
        if more and not os.fork():
            if not os.fork():
                for each in more:
                    time.sleep(SPAN)
                    os.kill(self._top, each)
            os._exit(0)
        os.kill(self._top, first)


def main() -> None:
    """Count, and run the command."""
    note, process, after, number, signals, *arguments = sys.argv[1:]
    sys.argv = ["phframe", *arguments]
    Moment(Path(note), int(process), after, int(number), [int(each) for each in signals.split(",")]).wait()
    runpy.run_module("phframe", run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
