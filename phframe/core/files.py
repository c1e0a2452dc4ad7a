"""The one way in which this project writes files: atomically, by a temporary file that is renamed into place.

A regular file is written beside its place and put there when it is whole. What is no regular file is never replaced: a
symbolic link is followed, a character device or a pipe is written into, anything else is refused.
"""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from phframe.core.errors import InputError
from phframe.core.paths import path_shown

_SHOWN = 40
"""Characters of a file's name in that of its temporary file, so that the latter is not too long where the former is not."""


class ThereAlreadyError(InputError):
    """A file or folder that is there and may not be overwritten."""

    def __init__(self, what: str) -> None:
        super().__init__(f"{what}, and nothing is overwritten unasked")


class NewFile:
    """A file that is being written: ``with NewFile(path) as file: file.part.write_bytes(...); file.put()``.

    Args:
        path: Where it is to be; parent directories are made.
        overwrite: Whether a regular file that is there may be replaced; it keeps its mode and, where allowed, its owner.
            A file that is new gets the mode that the umask leaves.

    Attributes:
        path: Where it is to be.
        part: The temporary file to write to until ``put``; it is there, and empty.

    Raises:
        InputError: If it cannot be written, or is there and may not be replaced.
    """

    def __init__(self, path: Path, *, overwrite: bool = True) -> None:
        self.path, self._overwrite = path, overwrite
        with _told(path):
            self._into = _is_stream(path)
            self._place = path if self._into else path.resolve()
            self._before = None if self._into else _replaceable(path, overwrite)
            folder = Path(tempfile.gettempdir()) if self._into else self._place.parent
            folder.mkdir(parents=True, exist_ok=True)
            self.part = folder / f".{path.name[:_SHOWN]}.{secrets.token_hex(6)}.part"
            mode = 0o666 if self._before is None else 0o600  # what is secret is so from the beginning
            try:
                os.close(os.open(self.part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode))
            except BaseException:  # an interruption, too, leaves nothing
                self.close()
                raise

    def put(self, *, synchronise: bool = True) -> None:
        """Put what was written in its place.

        Args:
            synchronise: Whether the content is to be on the disk before the name is; else it is the system that sees to it.

        Raises:
            InputError: If that is not possible; the temporary file is gone, and what was there before is still there.
        """
        with self, _told(self.path):
            if self._into:
                _pour(self.part, self._place)
                return
            if synchronise:
                _synchronise(self.part)
            if self._before is not None:
                _take_after(self.part, self._before)
            if self._overwrite:
                _refuse_changed(self._place)
                self.part.replace(self._place)
            else:
                _move_to_free(self.part, self._place)

    def close(self) -> None:
        """Leave nothing, unless it is put. May be called twice."""
        with suppress(OSError):
            self.part.unlink(missing_ok=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def check_writable(path: Path, *, overwrite: bool = True) -> None:
    """Find out whether a file can be written, before much is computed for it. Nothing is left.

    Raises:
        InputError: As ``NewFile``.
    """
    with _told(path):
        if not _is_stream(path):
            _replaceable(path, overwrite)
            _check_folder(path.resolve().parent)


def write_file(path: Path, content: str | bytes, *, overwrite: bool = True) -> Path:
    """Write a file, whole or not at all; text as UTF-8. As ``NewFile``.

    Raises:
        InputError: If it cannot be written, or is there and may not be replaced.
    """
    return write_file_by(path, lambda part: part.write_bytes(_encoded(content)), overwrite=overwrite)


def _encoded(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def write_file_by(path: Path, write: Callable[[Path], object], *, overwrite: bool = True) -> Path:
    """Write a file, whole or not at all, by what fills an empty one bit by bit. As ``NewFile``.

    Args:
        path: Where it is to be.
        write: Fills the temporary file whose path it is given.
        overwrite: Whether a regular file that is there may be replaced.

    Raises:
        InputError: If it cannot be written, or is there and may not be replaced.
    """
    with NewFile(path, overwrite=overwrite) as file:
        with _told(path):
            write(file.part)
        file.put()
    return path


def check_folder_writable(path: Path, *, overwrite: bool = False) -> None:
    """Find out whether a folder of files can be written, before much is computed for it. Nothing is left.

    Raises:
        InputError: As ``write_folder``.
    """
    with _told(path):
        if path.exists() and not path.is_dir():
            raise InputError(f"cannot write the directory {path_shown(path)}: there is a file. Name another path.")
        if path.is_dir() and not overwrite and any(path.iterdir()):
            raise ThereAlreadyError(f"{path_shown(path)} is not empty")
        _check_folder(path.resolve())


def write_folder(path: Path, files: Mapping[str, str | bytes], *, overwrite: bool = False) -> Path:
    """Write a folder of files; a new one appears whole or not at all.

    Args:
        path: The folder; a symbolic link to one is followed.
        files: What they hold, text as UTF-8, by their paths in it.
        overwrite: Whether it may hold files already, those of the same names to be replaced one by one, the others kept.

    Raises:
        InputError: If it cannot be written, or holds something and may not.
    """
    check_folder_writable(path, overwrite=overwrite)
    if path.exists():
        with _told(path):
            _refill(path.resolve(), files, overwrite)
    else:
        with new_folder(path) as made:
            for name, content in files.items():
                write_file(made / name, content)
    return path


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """A folder that is filled under another name, which this gives, and put in place at the end; after an error it is gone.

    Raises:
        InputError: If it cannot be written, or there is one that is not empty.
    """
    check_folder_writable(path)
    with _told(path):
        place = path.resolve()
        place.parent.mkdir(parents=True, exist_ok=True)
        made = place.parent / f".{place.name[:_SHOWN]}.{secrets.token_hex(6)}.part"
        made.mkdir()
    try:
        yield made
        with _told(path):
            if place.exists():
                place.rmdir()
            made.rename(place)
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _refill(place: Path, files: Mapping[str, str | bytes], overwrite: bool) -> None:
    """Write all files beside their places before the first is put."""
    new: list[NewFile] = []
    try:
        for name, content in files.items():
            new.append(NewFile(place / name, overwrite=overwrite))
            new[-1].part.write_bytes(_encoded(content))
        for file in new:
            file.put()
    finally:
        for file in new:
            file.close()


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """What the system refuses, as an error for people."""
    try:
        yield
    except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: a loop of links
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot write {path_shown(path)}: {why[:1].lower()}{why[1:]}") from None


def _status(path: Path) -> os.stat_result | None:
    """Of what a path, its links followed, leads to; None: of nothing."""
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _is_stream(path: Path) -> bool:
    """Whether what is there is written into: a character device such as a terminal, or a pipe."""
    status = _status(path)
    if status is None or not (stat.S_ISCHR(status.st_mode) or stat.S_ISFIFO(status.st_mode)):
        return False
    _check_allowed(path)
    return True


def _check_allowed(path: Path) -> None:
    if not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _replaceable(path: Path, overwrite: bool) -> os.stat_result | None:
    """The status of the regular file that is there, if any.

    Raises:
        InputError: If it may not be replaced.
    """
    status = _status(path)
    if status is None:
        return None
    if stat.S_ISDIR(status.st_mode):
        raise InputError(f"cannot write {path_shown(path)}: it is a directory. Name a file.")
    if not stat.S_ISREG(status.st_mode):
        raise InputError(f"cannot write {path_shown(path)}: it is a block device or a socket. Name a file.")
    if not overwrite:
        raise _there(path)
    _check_allowed(path)
    return status


def _refuse_changed(place: Path) -> None:
    """See that nobody has put a link, a pipe or a device where a file was, or nothing, when its writing began."""
    with suppress(FileNotFoundError):
        if not stat.S_ISREG(place.lstat().st_mode):
            raise InputError(f"cannot write {path_shown(place)}: what is there now is no regular file")


def _there(path: Path) -> ThereAlreadyError:
    return ThereAlreadyError(f"{path_shown(path)} is there already")


def _check_folder(folder: Path) -> None:
    """Whether files can be made in a folder, or it can be made in the nearest of its parents that is there."""
    while not folder.exists():
        folder = folder.parent
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, f"{path_shown(folder)} is no directory")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _synchronise(part: Path) -> None:
    """Have the content on the disk before the name is: a crash in between must not leave an empty file."""
    with part.open("r+b") as stream:
        os.fsync(stream.fileno())


def _take_after(part: Path, before: os.stat_result) -> None:
    """Give a file the owner, where allowed, and the mode of the one that it replaces."""
    if hasattr(os, "chown"):
        with suppress(OSError):
            os.chown(part, before.st_uid, before.st_gid)
    part.chmod(stat.S_IMODE(before.st_mode))


def _move_to_free(part: Path, place: Path) -> None:
    """Rename a file to a name that nothing has, also if somebody takes it at this moment."""
    try:
        os.link(part, place)
    except FileExistsError:
        raise _there(place) from None
    except OSError:  # a file system without hard links: the name is taken first
        try:
            os.close(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            raise _there(place) from None
        part.replace(place)


def _pour(part: Path, stream: Path) -> None:
    """Copy a file into a device or a pipe, without waiting for somebody to read from the latter."""
    try:
        handle = os.open(stream, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0))
    except OSError as error:
        if error.errno == errno.ENXIO:
            raise OSError(error.errno, "nobody reads from this pipe") from None
        raise
    with part.open("rb") as source, os.fdopen(handle, "wb") as sink:
        os.set_blocking(handle, True)
        shutil.copyfileobj(source, sink)
