"""Where a command that makes files puts them: a file, a new folder, or standard output."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from phframe.cli.console import emit, note
from phframe.core.errors import InputError
from phframe.core.paths import user_path

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
        if self._path is not None:
            _check(self._path, force=force, folder=folder)

    def write(self, text: str) -> None:
        """Write the whole file, or nothing."""
        if self._path is None:
            emit(text.rstrip("\n"))
            return
        self.write_bytes(text.encode())

    def write_bytes(self, content: bytes) -> None:
        """Write the whole file, or nothing."""
        assert self._path is not None, "bytes are for files"
        from phframe.runtime.files import write_whole

        write_whole(self._path, content)
        note(f"wrote {self._path}")

    def write_folder(self, files: Mapping[str, str]) -> None:
        """Write a folder of files, given by their paths in it; a new one appears whole or not at all."""
        assert self._path is not None, "a folder has a path"
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            made = Path(tempfile.mkdtemp(dir=self._path.parent, prefix=f".{self._path.name}."))
            try:
                _fill(made, files)
                _put(made, self._path, files)
            finally:
                shutil.rmtree(made, ignore_errors=True)
        except OSError as error:
            raise InputError(f"cannot write {self._path}: {error.strerror or error}") from None
        note(f"wrote {len(files)} files into {self._path}")


def _check(path: Path, *, force: bool, folder: bool) -> None:
    try:
        there, is_folder = path.exists(), path.is_dir()
        full = is_folder and any(path.iterdir())
    except (OSError, ValueError) as error:
        raise InputError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None
    if there and is_folder is not folder:
        raise InputError(f"{path} is a {'directory' if is_folder else 'file'}. Name another path with --out.")
    if (full if folder else there) and not force:
        what = "is not empty" if folder else "is there already"
        raise InputError(f"{path} {what}, and nothing is overwritten without --force.")


def _fill(folder: Path, files: Mapping[str, str]) -> None:
    folder.chmod(0o755)
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")


def _put(made: Path, path: Path, files: Mapping[str, str]) -> None:
    """Move the folder to its place; into one that is in use, file by file."""
    if not path.exists() or not any(path.iterdir()):
        if path.exists():
            path.rmdir()
        made.rename(path)
        return
    for name in files:
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (made / name).replace(path / name)
