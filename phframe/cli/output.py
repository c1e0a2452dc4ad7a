"""Where a command that makes files puts them: a file, a new folder, or standard output."""

from __future__ import annotations

from collections.abc import Mapping

from phframe.cli.console import emit, note
from phframe.core.errors import InputError
from phframe.core.files import ThereAlreadyError, check_folder_writable, check_writable, write_file, write_folder
from phframe.core.paths import path_shown, user_path

STANDARD_OUTPUT = "-"


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
            emit(content.rstrip("\n"))
            return
        write_file(self._path, content, overwrite=self._force)
        note(f"wrote {path_shown(self._path)}")

    def write_folder(self, files: Mapping[str, str | bytes]) -> None:
        """Write a folder of files, given by their paths in it; a new one appears whole or not at all."""
        assert self._path is not None, "a folder has a path"
        write_folder(self._path, files, overwrite=self._force)
        note(f"wrote {len(files)} files into {path_shown(self._path)}")
