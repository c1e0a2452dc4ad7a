"""The directory of one run: made only when there is something to put into it, and never one that is in use."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Collection
from datetime import datetime
from functools import partial
from itertools import count
from pathlib import Path
from weakref import finalize

from phframe.core.errors import InputError

RUNS = Path("runs")
_LONGEST = 40


class RunDirectory:
    """A directory for the files of one run.

    Args:
        asked: The directory; it must be new or empty. None: a new one in ``runs/``.
        keep: Whether there is to be one at all.
        own: Names of files that may be in it: what an earlier start that was cut short has left.

    Raises:
        InputError: If it exists and is not an empty directory.
    """

    def __init__(self, asked: Path | None, *, keep: bool = True, own: Collection[str] = ()) -> None:
        self._asked, self.keep, self._own = asked, keep, own
        self.path: Path | None = None
        self._release: Callable[[], object] = lambda: None
        if asked is not None:
            _check_free(asked, own)

    def make(self, *names: str) -> Path:
        """Make the directory.

        Args:
            names: What a new one is called after its time.

        Raises:
            InputError: If that is not possible, or another run has it.
        """
        wanted = self._asked or RUNS
        try:
            if self._asked is None:
                self.path = _make_new(RUNS, names)
            else:
                self._release = finalize(self, _claimed(self._asked))
                _check_free(self._asked, self._own)  # somebody may have been here since it was checked first
                self.path = self._asked
        except OSError as error:
            raise cannot_write(wanted, error) from None
        return self.path

    def discard_if_empty(self) -> None:
        """Leave nothing behind where nothing was written. The run is over: the directory may be had by others."""
        self._release()
        if self.path is not None and self.path.is_dir() and not any(self.path.iterdir()):
            self.path.rmdir()
            self.path = None


def cannot_write(path: Path, error: OSError) -> InputError:
    """The error for people when a file or directory cannot be written."""
    reason = error.strerror or str(error)
    return InputError(
        f"cannot write to {path}: {reason[:1].lower()}{reason[1:]}. Name another directory with --out DIR."
    )


def _check_free(path: Path, own: Collection[str]) -> None:
    try:
        if path.exists() and not path.is_dir():
            raise InputError(f"--out {path} is a file. Name a directory that is new or empty.")
        if path.is_dir() and any(each.name not in own for each in path.iterdir()):
            raise InputError(
                f"--out {path} is not empty, and nothing is overwritten. Name a new directory or empty it."
            )
    except (OSError, ValueError) as error:
        raise cannot_write(path, error if isinstance(error, OSError) else OSError(str(error))) from None


def _claimed(path: Path) -> Callable[[], object]:
    """Make a directory and have it alone, until what this returns is called: of two runs that start at once, one goes on.

    The lock is the system's, so nothing is left of a process that is killed. Windows has none.

    Raises:
        InputError: If another run has it.
    """
    path.mkdir(parents=True, exist_ok=True)
    if sys.platform == "win32":
        return lambda: None
    import fcntl

    claim = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(claim, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(claim)
        raise InputError(f"--out {path} is in use by another run. Name another directory.") from None
    except OSError:  # a file system without locks
        os.close(claim)
        return lambda: None
    return partial(os.close, claim)


def _make_new(parent: Path, names: tuple[str, ...]) -> Path:
    """A directory that was not there before: of two runs that start at the same moment, only one can make it."""
    parent.mkdir(parents=True, exist_ok=True)
    stem = "-".join([f"{datetime.now().astimezone():%Y%m%d-%H%M%S}", *map(_plain, names)])
    for number in count(1):
        path = parent / (stem if number == 1 else f"{stem}-{number}")
        try:
            path.mkdir()
        except FileExistsError:
            continue
        return path
    raise AssertionError("unreachable: count() does not end")


def _plain(name: str) -> str:
    """A name without what a path cannot hold."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")[-_LONGEST:].strip("-") or "unnamed"
