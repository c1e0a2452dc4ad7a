"""Writes an episode while it grows, so that whatever ends it, what there is of it is on the disk."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from phframe.core import Episode, InputError
from phframe.core.files import NewFile, write_file
from phframe.core.paths import path_shown
from phframe.runtime.files import FORMAT, content_of

_LASTING = ("scene", "spec", "versions")
"""Fields of an episode that stay as they are while it runs."""


class EpisodeFile:
    """The file of one episode. Each plan and each step is turned into JSON once, however often the file is written.

    Args:
        path: The file; a regular one that is there is replaced.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._plans: list[str] = []
        self._steps: list[str] = []
        self._texts: dict[str, str] = {}

    def keep(self, episode: Episode) -> None:
        """Write what there is so far: whole, but left to the system when it gets to the disk.

        Raises:
            InputError: If it cannot be written, or what a part of the run made cannot be stored.
        """
        text = self._text(episode).encode()
        with NewFile(self.path) as file:
            try:
                file.part.write_bytes(text)
            except OSError as error:
                raise InputError(f"cannot write {path_shown(self.path)}: {error.strerror or error}") from None
            file.put(synchronise=False)

    def save(self, episode: Episode) -> Path:
        """Write an episode that is over, as ``save`` does.

        Raises:
            InputError: As ``keep``.
        """
        return write_file(self.path, self._text(episode))

    def _text(self, episode: Episode) -> str:
        """As ``save`` writes it."""
        plans, steps = episode.plans[len(self._plans) :], episode.steps[len(self._steps) :]
        new = content_of(replace(episode, plans=plans, steps=steps), without=_LASTING if self._texts else ())
        self._plans += map(json.dumps, new["plans"])
        self._steps += map(json.dumps, new["steps"])
        self._texts |= {name: json.dumps(value) for name, value in new.items()}
        self._texts |= {"plans": f"[{', '.join(self._plans)}]", "steps": f"[{', '.join(self._steps)}]"}
        content = ", ".join(f'"{name}": {text}' for name, text in self._texts.items())
        return f'{{"phframe": {FORMAT}, "kind": "episode", "episode": {{{content}}}}}'
