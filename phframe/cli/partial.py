"""What there is of an episode, so that an interruption loses nothing."""

from __future__ import annotations

from phframe.core import Episode
from phframe.runtime.observer import Observer


class PartialEpisode(Observer):
    """Keeps the episode, whether it is over or was interrupted.

    Attributes:
        episode: What there is of it; None: nothing yet.
    """

    def __init__(self) -> None:
        self.episode: Episode | None = None

    def finished(self, episode: Episode) -> None:
        """Keep the whole."""
        self.episode = episode

    def interrupted(self, episode: Episode) -> None:
        """Keep what there is."""
        self.episode = episode
