"""The text of a file that somebody wrote, YAML or other."""

from __future__ import annotations

from pathlib import Path

from phframe.core import DocumentError, InputError
from phframe.core.paths import path_shown, user_path
from phframe.core.regular_file import read_regular_file

MAX_BYTES = 1_000_000
"""Larger files are refused unread: a scene of a thousand objects has a tenth of that."""


def read_text(path: str | Path, what: str, most: int = MAX_BYTES) -> str:
    """The text of a file.

    Args:
        path: The file.
        what: It is to be, for the error, such as ``scene file``.
        most: Bytes of the largest that is read.

    Raises:
        InputError: If it cannot be read.
        DocumentError: If it is too large, or not UTF-8.
    """
    source = path_shown(path)
    return _decoded(_content(user_path(path), source, what, most), source)


def refuse_size(size: int, source: str, what: str, most: int = MAX_BYTES) -> None:
    """See that a text is not too large for a file of its kind.

    Raises:
        DocumentError: If it is.
    """
    if size > most:
        raise DocumentError(f"larger than {most // 1_000_000} MB; that is no {what}", source)


def _content(path: Path, source: str, what: str, most: int) -> bytes:
    try:
        content = read_regular_file(path, most + 1)
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot read the {what} {source}: {reason[:1].lower()}{reason[1:]}") from None
    refuse_size(len(content), source, what, most)
    return content


def _decoded(content: bytes, source: str) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise DocumentError(f"line {line}: not UTF-8 text (byte 0x{content[error.start]:02x})", source) from None
