"""One bench at a time in a directory."""

from __future__ import annotations

import os
from pathlib import Path

from phframe.bench.store import StoreError
from phframe.core.paths import path_shown

LOCK = "lock"
"""What the file is called that is locked."""


class DirectoryLock:
    """Held until it is closed, or its process ends, however it does.

    Args:
        directory: What is locked; it is there.

    Raises:
        StoreError: If another process holds it, or the directory cannot be written.
    """

    def __init__(self, directory: Path) -> None:
        import fcntl  # none on Windows

        try:
            self._handle = os.open(directory / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError as error:
            why = error.strerror or str(error)
            raise StoreError(f"cannot write to {path_shown(directory)}: {why[:1].lower()}{why[1:]}") from None
        try:
            fcntl.flock(self._handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(self._handle)
            raise StoreError(
                f"another phframe bench is at work in {path_shown(directory)}: wait for it, or name another directory"
            ) from None

    def close(self) -> None:
        """Let others in."""
        os.close(self._handle)
