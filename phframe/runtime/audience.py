"""All observers of a run as one. What one of them does wrong costs it its seat, and never the episode."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

from phframe.core import Episode, PhframeError, Plan, RunSpec, Scene, Step
from phframe.core.errors import error_text
from phframe.runtime.observer import Frames, MountedArm, Observer


class ObserverError(PhframeError):
    """An observer failed, such as a recorder on a full disk; the episode is whole.

    Args:
        what: Which one, and how.
        episode: The episode.
    """

    def __init__(self, what: str, episode: Episode) -> None:
        self.what, self.episode = what, episode
        super().__init__(what)

    def __reduce__(self) -> tuple[type[ObserverError], tuple[str, Episode]]:
        return type(self), (self.what, self.episode)


class Audience(Observer):
    """Tells every observer. One that raises is told no more; as an episode begins, its complaint is fatal.

    Args:
        observers: Who looks on. They are closed with this one, each whatever the others do.

    Attributes:
        failures: What went wrong, in the order in which it did.
    """

    def __init__(self, observers: Sequence[Observer]) -> None:
        self._all, self._seated = tuple(observers), list(observers)
        self.failures: list[str] = []

    @property
    def is_empty(self) -> bool:
        """Whether nobody looks on."""
        return not self._seated

    def mounting(self, done: int, of: int) -> None:
        """Tell them."""
        self._tell(lambda each: each.mounting(done, of))

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """Tell them.

        Raises:
            PhframeError: If one says that it cannot do what it is for. Nothing has been done yet.
        """
        self._tell(lambda each: each.begin(scene, spec, arm), PhframeError)

    def planning(self, seconds: float) -> None:
        """Tell them."""
        self._tell(lambda each: each.planning(seconds))

    def planned(self, plan: Plan) -> None:
        """Tell them."""
        self._tell(lambda each: each.planned(plan))

    def acting(self, seconds: float) -> None:
        """Tell them."""
        self._tell(lambda each: each.acting(seconds))

    def stepped(self, step: Step, frames: Frames) -> None:
        """Tell them."""
        self._tell(lambda each: each.stepped(step, frames))

    def progressed(self, episode: Episode) -> None:
        """Tell them."""
        self._tell(lambda each: each.progressed(episode))

    def finished(self, episode: Episode) -> None:
        """Tell them."""
        self._tell(lambda each: each.finished(episode))

    def interrupted(self, episode: Episode) -> None:
        """Tell them."""
        self._tell(lambda each: each.interrupted(episode))

    def close(self) -> None:
        """Close them all."""
        waiting: list[KeyboardInterrupt] = []
        for each in reversed(self._all):
            try:
                self._attend(each, lambda each: each.close())
            except KeyboardInterrupt as error:  # the others are closed all the same
                waiting.append(error)
        self._all = ()
        if waiting:
            raise waiting[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _tell(self, what: Callable[[Observer], None], *fatal: type[BaseException]) -> None:
        for each in tuple(self._seated):
            self._attend(each, what, *fatal)

    def _attend(self, observer: Observer, what: Callable[[Observer], None], *fatal: type[BaseException]) -> None:
        try:
            what(observer)
        except BaseException as error:
            if isinstance(error, (KeyboardInterrupt, *fatal)):
                raise
            if observer in self._seated:
                self._seated.remove(observer)
            self.failures.append(_complaint(observer, error))


def _complaint(observer: Observer, error: BaseException) -> str:
    return f"{observer.title or type(observer).__name__} failed: {error_text(error)}"
