"""Where a command that makes files puts them: a file, a new folder, or standard output."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import islice
from pathlib import Path

from phframe.cli.console import deliver, note
from phframe.core.errors import InputError
from phframe.core.files import (
    ThereAlreadyError,
    check_folder_writable,
    check_writable,
    write_file,
    write_file_by,
    write_folder,
)
from phframe.core.paths import path_shown, user_path

STANDARD_OUTPUT = "-"
BLOCK = 1000
"""Lines that are written at a time."""


class Output:
    """A file or folder to be written.

    Args:
        asked: Its path, or ``-`` for standard output.
        force: Whether files that are there may be overwritten.
        folder: Whether it is a folder of files.

    Raises:
        InputError: If it is there already, or cannot be. Nothing has been written then.
    """

    def __init__(self, asked: str, *, force: bool, folder: bool = False) -> None:
        self._force = force
        self._path = None if asked == STANDARD_OUTPUT else user_path(asked)
        if self._path is None:
            return
        try:
            (check_folder_writable if folder else check_writable)(self._path, overwrite=force)
        except ThereAlreadyError as error:
            raise InputError(f"{error}: take --force, or another path with --out.") from None

    def write(self, content: str | bytes) -> None:
        """Write the whole file, or nothing; to standard output, text."""
        if self._path is None:
            assert isinstance(content, str), "bytes are for files"
            deliver(content.rstrip("\n"))
            return
        write_file(self._path, content, overwrite=self._force)
        note(f"wrote {path_shown(self._path)}")

    def write_lines(self, lines: Iterable[str]) -> None:
        """Write a text as its lines come, so that it may be longer than memory; the whole file, or nothing."""
        rest = iter(lines)
        blocks = iter(lambda: "\n".join(islice(rest, BLOCK)), "")
        if self._path is None:
            for block in blocks:
                deliver(block)
        else:
            self.write_by(lambda part: _fill(part, blocks))

    def write_by(self, write: Callable[[Path], object]) -> None:
        """Write the whole file, or nothing, by what fills an empty one."""
        assert self._path is not None, "bytes are for files"
        write_file_by(self._path, write, overwrite=self._force)
        note(f"wrote {path_shown(self._path)}")

    def write_folder(self, files: Mapping[str, str | bytes]) -> None:
        """Write a folder of files, given by their paths in it; a new one appears whole or not at all."""
        assert self._path is not None, "a folder has a path"
        write_folder(self._path, files, overwrite=self._force)
        note(f"wrote {len(files)} files into {path_shown(self._path)}")


def _fill(part: Path, blocks: Iterable[str]) -> None:
    with part.open("w", encoding="utf-8", newline="\n") as stream:
        stream.writelines(f"{block}\n" for block in blocks)
