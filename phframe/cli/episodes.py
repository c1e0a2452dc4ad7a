"""From what a user calls an episode to the episode."""

from __future__ import annotations

from pathlib import Path

from phframe.cli.watchdog import EPISODE
from phframe.core import Episode, InputError
from phframe.core.paths import path_shown
from phframe.runtime.files import load


def read_episode(path: Path) -> Episode:
    """The episode in a directory that ``phframe solve`` made, or in a file.

    Raises:
        InputError: If there is none.
    """
    try:
        file = path / EPISODE if path.is_dir() else path
        if file != path and not file.exists():
            raise InputError(
                f"the directory {path_shown(path)} holds no {EPISODE}. Name one that 'phframe solve' made."
            )
    except OSError as error:
        raise InputError(f"cannot read {path_shown(path)}: {error.strerror}") from None
    loaded = load(file)
    if not isinstance(loaded, Episode):
        raise InputError(f"{path_shown(path)} is a plan, not an episode: nothing was carried out")
    return loaded
