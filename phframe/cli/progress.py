"""What ``solve`` is doing, on a terminal, once it has taken a second."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer

from phframe.cli.console import error_console
from phframe.core import Episode, Plan, RunSpec, Scene, State, Step
from phframe.runtime.observer import Frames, MountedArm, Observer

AFTER = 1.0
"""Seconds before anything is shown."""


class Progress(Observer):
    """A line on standard error that says what is being done; nothing where that is no terminal.

    Args:
        after: Seconds before it appears.
    """

    def __init__(self, after: float = AFTER) -> None:
        self._console = error_console()
        self._status = self._console.status("Loading the libraries (the first time, what is compiled takes a minute)")
        self._after, self._wanted = after, False
        self._timer = self._new_timer()
        self._to_do, self._plans, self._done = 0, 0, 0

    def start(self) -> None:
        """Begin to count the seconds."""
        self._wanted = self._console.is_terminal
        if self._wanted:
            self._timer.start()

    @contextmanager
    def aside(self) -> Iterator[None]:
        """Leave the screen to somebody else; come back a while after."""
        self._take_away()
        try:
            yield
        finally:
            self._timer = self._new_timer()
            if self._wanted:
                self._timer.start()

    def mounting(self, done: int, of: int) -> None:
        """Where the base is to stand is being looked for."""
        self._status.update(f"Looking where the base has to stand: {done} of {of}")

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """The first plan is being made."""
        self._status.update(f"Planning with {spec.name_of('planner')} for {scene.name}")

    def planned(self, plan: Plan) -> None:
        """A plan is about to be carried out."""
        self._plans += 1
        self._to_do, self._done = len(plan.actions), 0
        self._tell()

    def stepped(self, step: Step, frames: Frames) -> None:
        """One more action was carried out."""
        self._done += 1
        self._tell()

    def through(self, frames: Frames) -> Iterator[tuple[float, State]]:
        """The same frames, while the line says how many of them have been drawn."""
        waiting = list(frames)
        for number, frame in enumerate(waiting):
            self._status.update(f"Filming action {self._done + 1}: {100 * number // len(waiting)} %")
            yield frame

    def finished(self, episode: Episode) -> None:
        """The files are being written."""
        self._status.update("Writing the files")

    def close(self) -> None:
        """Take the line away."""
        self._wanted = False
        self._take_away()

    def _new_timer(self) -> Timer:
        timer = Timer(self._after, self._status.start)
        timer.daemon = True
        return timer

    def _take_away(self) -> None:
        self._timer.cancel()
        if self._timer.is_alive():
            self._timer.join()
        self._status.stop()

    def _tell(self) -> None:
        replans = f" (plan {self._plans})" if self._plans > 1 else ""
        if self._done < self._to_do:
            self._status.update(f"Carrying out action {self._done + 1} of {self._to_do}{replans}")
        else:
            self._status.update("Looking at the result")
