"""Where the commands write to: results to standard output, everything else to standard error."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from contextvars import ContextVar
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

UNLIMITED = 10_000
"""Columns where no terminal sets a limit: files and pipes get whole lines."""


def note(text: str) -> None:
    """A line for people, beside the result."""
    _write(sys.stderr, text)


def emit(text: str) -> None:
    """The result, as text."""
    _write(_results(), text)


def show(what: RenderableType) -> None:
    """The result, as a table or another picture of it."""
    from rich.console import Console

    console = Console(highlight=False, file=_results())
    if not console.is_terminal:
        console.width = _columns()
    with console.capture() as capture:
        console.print(what)
    emit("\n".join(line.rstrip() for line in capture.get().rstrip("\n").split("\n")))


def error_console() -> Console:
    """Standard error, for progress."""
    from rich.console import Console

    return Console(stderr=True, highlight=False)


def leave(stream: TextIO) -> None:
    """Let what is still to be written to a stream that takes no more vanish."""
    with open(os.devnull, "wb") as nowhere:  # noqa: PTH123 - os.devnull is no path on every system
        os.dup2(nowhere.fileno(), stream.fileno())


def reserve_output() -> None:
    """Keep standard output for ``sys.stdout`` from now on.

    What else writes to it, as do libraries in C and processes that are started, writes to standard error.
    """
    own = _copy_of(1)
    _lead(1, 2)
    if own is not None and sys.stdout is not None:
        encoding, errors = sys.stdout.encoding, sys.stdout.errors
        sys.stdout = os.fdopen(own, "w", 1 if os.isatty(own) else -1, encoding=encoding, errors=errors)


def release_output() -> None:
    """Undo ``reserve_output`` for a command whose output is the result, whatever writes it."""
    with suppress(AttributeError, io.UnsupportedOperation, OSError):  # there is none, or it is no file
        _lead(1, sys.stdout.fileno())


@contextmanager
def results_only() -> Iterator[None]:
    """Meanwhile ``emit`` and ``show`` alone write to standard output; what else is printed goes to standard error."""
    before = _RESULTS.set(_results())
    try:
        with redirect_stdout(sys.stderr):
            yield
    finally:
        _RESULTS.reset(before)


_RESULTS: ContextVar[TextIO | None] = ContextVar("results", default=None)
"""Where results go while ``sys.stdout`` leads elsewhere."""


def _results() -> TextIO:
    return _RESULTS.get() or sys.stdout


def _copy_of(descriptor: int) -> int | None:
    """Another descriptor of the same file, which processes that are started do not have; None: it is closed."""
    try:
        return os.dup(descriptor)
    except OSError:
        return None


def _lead(descriptor: int, to: int) -> None:
    """Make a descriptor one of another's file; of none, if that is closed."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(to, descriptor)
    except OSError:
        os.dup2(nowhere, descriptor)
    if nowhere != descriptor:
        os.close(nowhere)


def _columns() -> int:
    given = os.environ.get("COLUMNS", "")
    return int(given) if given.isdigit() and int(given) > 0 else UNLIMITED


def _write(stream: TextIO | None, text: str) -> None:
    """Write a line; where nobody reads on (``phframe scenes | head -1``) it is dropped."""
    if stream is None:  # closed from the beginning
        return
    encoding = stream.encoding or "utf-8"
    try:
        stream.write(text.encode(encoding, errors="replace").decode(encoding) + "\n")
        stream.flush()
    except BrokenPipeError:
        leave(stream)
    except OSError as error:
        leave(stream)
        _complain(error)


def _complain(error: OSError) -> None:
    from phframe.core.errors import InputError

    raise InputError(f"cannot write the output: {(error.strerror or str(error)).lower()}") from None
