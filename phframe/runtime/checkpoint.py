"""Writes an episode while it grows, so that whatever ends it, what there is of it is on the disk."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from phframe.core import Episode, InputError, Plan, Step
from phframe.core.files import NewFile, write_file
from phframe.core.paths import path_shown
from phframe.runtime.files import FORMAT, bounded_plan


class EpisodeFile:
    """The file of one episode. Each plan and each step is written as JSON once, however often the file is.

    Args:
        path: The file; a regular one that is there is replaced.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._plans: list[str] = []
        self._steps: list[str] = []

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
        episode.spec.to_json()  # refuses what cannot be stored, which a serializer would wrap
        _extend(self._plans, [bounded_plan(plan) for plan in episode.plans[len(self._plans) :]], Plan)
        _extend(self._steps, episode.steps[len(self._steps) :], Step)
        fields = TypeAdapter(Episode).dump_python(replace(episode, plans=(), steps=()), mode="json")
        parts = {name: json.dumps(value) for name, value in fields.items()}
        parts |= {"plans": f"[{', '.join(self._plans)}]", "steps": f"[{', '.join(self._steps)}]"}
        content = ", ".join(f'"{name}": {text}' for name, text in parts.items())
        return f'{{"phframe": {FORMAT}, "kind": "episode", "episode": {{{content}}}}}'


def _extend(texts: list[str], values: Sequence[Any], kind: type) -> None:
    adapter: TypeAdapter[Any] = TypeAdapter(kind)
    texts.extend(json.dumps(adapter.dump_python(value, mode="json")) for value in values)
