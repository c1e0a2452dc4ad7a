"""What there is of an episode, on the disk while it grows, so that nothing that ends it loses it."""

from __future__ import annotations

from contextlib import suppress

from phframe.cli.run_directory import RunDirectory
from phframe.cli.watchdog import EPISODE
from phframe.core import Episode
from phframe.core.errors import PhframeError
from phframe.runtime.checkpoint import EpisodeFile
from phframe.runtime.observer import Observer


class PartialEpisode(Observer):
    """Writes the episode as it begins, and after every plan and every action.

    Args:
        directory: Where; nothing is written before it is made.

    Attributes:
        episode: What there is of it; None: nothing yet.
        kept: Whether it is on the disk as it is.
    """

    def __init__(self, directory: RunDirectory) -> None:
        self.episode: Episode | None = None
        self.kept = False
        self._directory = directory
        self._file: EpisodeFile | None = None

    def progressed(self, episode: Episode) -> None:
        """Keep what there is. That it cannot be written is told at the end, where it matters."""
        self.episode, self.kept = episode, False
        if (file := self._at()) is not None:
            with suppress(PhframeError):
                file.keep(episode)
                self.kept = True

    def finished(self, episode: Episode) -> None:
        """Keep the whole, before other observers come to their end; ``save`` sees to it that it is on the disk."""
        self.progressed(episode)

    def interrupted(self, episode: Episode) -> None:
        """Keep what there is."""
        self.progressed(episode)

    def save(self, episode: Episode) -> None:
        """Write an episode that is over.

        Raises:
            InputError: If it cannot be written.
        """
        if (file := self._at()) is not None:
            file.save(episode)

    def _at(self) -> EpisodeFile | None:
        if self._file is None and self._directory.path is not None:
            self._file = EpisodeFile(self._directory.path / EPISODE)
        return self._file
