"""Answers of distributions, kept from one process to the next for as long as no file has changed that they come from."""

from __future__ import annotations

import hashlib
import json
import os
import stat
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import asdict
from importlib.machinery import PathFinder
from pathlib import Path

from phframe.core.distributions import PluginDistribution
from phframe.core.errors import PluginError
from phframe.core.version import own_version
from phframe.registry.answer import MOST_BYTES, UNREADABLE, Answer, read, to_json
from phframe.registry.extension import API_VERSION

DIRECTORY = "PHFRAME_CACHE"
"""Environment variable: the directory of what phframe keeps between runs; empty: it keeps nothing."""
HASTY = 600.0
"""Seconds for which it is kept that an answer took too long."""
_FORMAT = 1

State = list[list[str | int]]
"""Path, time of change (ns) and size of files."""


class AnswerCache:
    """Kept answers. One that cannot be read or kept is asked for anew.

    Args:
        folder: Where they are; None: nowhere.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder if folder is not None and _is_private(folder) else None

    def get(self, asked: PluginDistribution) -> Answer | None:
        """What a distribution answered; None: it has to be asked."""
        with suppress(OSError, PluginError, *UNREADABLE):
            file = self._file(asked)
            if file is None or not stat.S_ISREG(file.stat().st_mode) or file.stat().st_size > 4 * MOST_BYTES:
                return None
            kept = json.loads(file.read_bytes())
            answer = read(kept["answer"])
            young = not answer.hasty or 0 <= time.time() - file.stat().st_mtime < HASTY
            if young and _state(str(path) for path, *_ in kept["state"]) == kept["state"]:
                return answer
        return None

    def put(self, asked: PluginDistribution, answer: Answer, since: int) -> None:
        """Keep an answer, unless what it comes from has changed while it was found out.

        Args:
            asked: Who gave it.
            answer: What it is.
            since: When asking began (ns).
        """
        with suppress(OSError, ValueError):
            file, state = self._file(asked), _state(_sources(asked, answer))
            if file is None or any(int(changed) >= since for _, changed, _ in state):
                return
            file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile("w", dir=file.parent, delete=False, encoding="ascii") as part:
                json.dump({"answer": to_json(answer), "state": state}, part)
            Path(part.name).replace(file)

    def _file(self, asked: PluginDistribution) -> Path | None:
        if self._folder is None or asked.folder is None:
            return None
        told = [
            _FORMAT,
            own_version(),
            API_VERSION,
            sys.version,
            sys.executable,
            list(map(str, sys.path)),
            _told(asked),
        ]
        return self._folder / f"{asked.name}-{hashlib.sha256(json.dumps(told).encode()).hexdigest()[:32]}.json"


def cache_folder() -> Path | None:
    """Where answers are kept; None: nowhere."""
    given = os.environ.get(DIRECTORY)
    if given is not None:
        return Path(given).absolute() / "plugins" if given else None
    with suppress(RuntimeError):
        base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or Path.home() / ".cache"
        return Path(base).absolute() / "phframe" / "plugins"
    return None


def _told(asked: PluginDistribution) -> dict[str, str | Sequence[str]]:
    return {**asdict(asked), "folder": str(asked.folder)}


def _sources(asked: PluginDistribution, answer: Answer) -> list[str]:
    """The files that an answer comes from; of one that went wrong, also the folders in which something may have been missing."""
    folder = str(asked.folder)
    files = [os.path.join(folder, name) for name in ("METADATA", "PKG-INFO", "entry_points.txt", "RECORD")]  # noqa: PTH118
    files += answer.files or [origin for hook in asked.hooks if (origin := _origin(hook))]
    return [*files, *(os.path.abspath(each) for each in sys.path if each)] if answer.error else files  # noqa: PTH100


def _origin(hook: str) -> str | None:
    """The file of the package, or of the module, that has a hook."""
    found = PathFinder.find_spec(hook.partition(":")[0].partition(".")[0])
    return found.origin if found else None


def _state(paths: Iterable[str]) -> State:
    state: State = []
    for path in paths:
        try:
            status = os.stat(path)  # noqa: PTH116 - quicker
            state.append([path, status.st_mtime_ns, status.st_size])
        except OSError:
            state.append([path, 0, -1])
    return state


def _is_private(folder: Path) -> bool:
    """Whether nobody else can write into a folder, or it can be made."""
    try:
        status = folder.stat()
    except OSError:
        return True
    return not hasattr(os, "getuid") or (status.st_uid == os.getuid() and not status.st_mode & 0o022)
