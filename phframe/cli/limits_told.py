"""Tells the watchdog what a run is about to do, and how long that may take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from phframe.cli.supervised import LOADING, WatchdogLink
from phframe.core import Episode, Plan, RunSpec, Scene, Step
from phframe.runtime.observer import Frames, MountedArm, Observer

PLANNING, ACTING = "planning", "carrying out"


class LimitsTold(Observer):
    """Hands the limits of a run on. What observers do, such as filming, takes as long as it takes.

    Args:
        link: To the watchdog.
    """

    def __init__(self, link: WatchdogLink) -> None:
        self._link, self._left = link, 0.0

    def mounting(self, done: int, of: int) -> None:
        """It gets on."""
        self._link.limit(LOADING, "looking where the base has to stand")

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """The world is there."""
        self._link.limit(LOADING, "loading")

    def planning(self, seconds: float) -> None:
        """The planner is asked."""
        self._left = seconds
        self._link.limit(seconds, PLANNING)

    def planned(self, plan: Plan) -> None:
        """It has answered."""
        self._link.limit(None)

    def acting(self, seconds: float) -> None:
        """The arm moves."""
        self._link.limit(seconds, ACTING)

    def stepped(self, step: Step, frames: Frames) -> None:
        """It has."""
        self._link.limit(None)

    def finished(self, episode: Episode) -> None:
        """Only the files are left to be written."""
        self._link.limit(None)

    def interrupted(self, episode: Episode) -> None:
        """Likewise."""
        self._link.limit(None)

    def stopping(self, aside: Callable[[], AbstractContextManager[None]]) -> Callable[[], AbstractContextManager[None]]:
        """The clock stands still while somebody is asked.

        Args:
            aside: Makes room on the screen.
        """

        @contextmanager
        def stopped() -> Iterator[None]:
            self._link.limit(None)
            try:
                with aside():
                    yield
            finally:
                self._link.limit(self._left, PLANNING)

        return stopped
