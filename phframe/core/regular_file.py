"""Reading files that somebody names: regular ones, and no pipe or device that is waited for, or read, for ever."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path


def read_regular_file(path: Path, most: int | None = None) -> bytes:
    """The content of a regular file, symbolic links followed; nothing is waited for.

    Args:
        path: The file.
        most: Bytes that are read at most; None: all.

    Raises:
        OSError: If there is none, it cannot be read, or what is there is not a regular file.
        ValueError: If the path has a zero byte.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    try:
        if not stat.S_ISREG(mode := os.fstat(handle).st_mode):
            why = os.strerror(errno.EISDIR) if stat.S_ISDIR(mode) else "not a regular file"
            raise OSError(errno.EISDIR if stat.S_ISDIR(mode) else errno.EINVAL, why, str(path))
        with os.fdopen(handle, "rb", closefd=False) as file:
            return file.read(-1 if most is None else most)
    finally:
        os.close(handle)
