"""Reads MuJoCo XML in a process that it may end, one file after another, and tells what came of each."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import get_context
from pathlib import Path

from phframe.core import PhframeError

MEMORY = 2 << 30
ENDED = "the process ended"
"""What is told of a file that ends the process that reads it, or takes too long."""


class MjcfReader:
    """A process that reads, and the next one once it has ended.

    Args:
        folder: Its working directory; what libraries write to standard error is in ``err`` beside it.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self._err = folder, folder.parent / "err"
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        where = (str(self.folder), str(self._err))
        return ProcessPoolExecutor(1, get_context("spawn"), initializer=_begin, initargs=where)

    def read(self, path: Path) -> str:
        """The scene in a file as text, or what is wrong, after a ``!``; ``ENDED`` if the process came to its end."""
        try:
            return self._pool.submit(_read, str(path)).result(timeout=60.0)
        except (BrokenProcessPool, TimeoutError):
            self.close()
            self._pool = self._new()
            return ENDED

    @property
    def chatter(self) -> str:
        """What was written to standard error."""
        return self._err.read_text(errors="replace") if self._err.exists() else ""

    def close(self) -> None:
        for process in list((self._pool._processes or {}).values()):
            process.kill()
        self._pool.shutdown()


def _begin(folder: str, err: str) -> None:
    os.chdir(folder)
    os.dup2(os.open(err, os.O_WRONLY | os.O_CREAT | os.O_APPEND), 2)
    with suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def _read(path: str) -> str:
    from phframe.scenes import parse_scene, scene_to_yaml
    from phframe.scenes.importer import to_scene
    from phframe.scenes.mujoco_ import read_mjcf

    return _told(lambda: scene_to_yaml(parse_scene(scene_to_yaml(to_scene(read_mjcf(path), "scene.xml").scene))))


def _told(read: Callable[[], str]) -> str:
    try:
        return read()
    except PhframeError as error:
        return f"!{error}"
    except MemoryError:
        return ENDED
