"""Where the commands write to: results to standard output, everything else to standard error.

Whatever is written is printable here, and messages are short here: nobody else has to see to it.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from contextvars import ContextVar
from typing import TYPE_CHECKING, TextIO

from phframe.cli.printable import abridged, printable

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

UNLIMITED = 10_000
"""Columns where no terminal sets a limit: files and pipes get whole lines."""


def note(text: str) -> None:
    """A line for people, beside the result."""
    _write(sys.stderr, printable(abridged(text)))


def emit(text: str) -> None:
    """The result, as text."""
    _write(_results(), printable(text))


def deliver(text: str) -> None:
    """The result, as a document for other programs: letter by letter what a file would hold, unless a terminal shows it."""
    results = _results()
    shown = results is not None and results.isatty()
    _write(results, printable(text) if shown else text)


def show(what: RenderableType) -> None:
    """The result, as a table or another picture of it."""
    from phframe.cli.rich_console import PrintableConsole

    console = PrintableConsole(highlight=False, file=_results())
    if not console.is_terminal:
        console.width = _columns()
    with console.capture() as capture:
        console.print(what)
    _write(_results(), "\n".join(line.rstrip() for line in capture.get().rstrip("\n").split("\n")))


def error_console() -> Console:
    """Standard error, for progress."""
    from phframe.cli.rich_console import PrintableConsole

    return PrintableConsole(stderr=True, highlight=False)


def leave(stream: TextIO) -> None:
    """Let what is still to be written to a stream that takes no more vanish."""
    with open(os.devnull, "wb") as nowhere:  # noqa: PTH123 - os.devnull is no path on every system
        os.dup2(nowhere.fileno(), stream.fileno())


def reserve_output() -> None:
    """Keep standard output for ``sys.stdout`` from now on.

    What else writes to it, as do libraries in C and processes that are started, writes to standard error.
    """
    _open_standard_streams()
    own = os.dup(1)  # processes that are started do not have it
    os.dup2(2, 1)
    if sys.stdout is not None:
        encoding, errors = sys.stdout.encoding, sys.stdout.errors
        sys.stdout = os.fdopen(own, "w", 1 if os.isatty(own) else -1, encoding=encoding, errors=errors)


def release_output() -> None:
    """Undo ``reserve_output`` for a command whose output is the result, whatever writes it."""
    with suppress(AttributeError, io.UnsupportedOperation):  # there is none, or it is no file
        os.dup2(sys.stdout.fileno(), 1)


@contextmanager
def results_only() -> Iterator[None]:
    """Meanwhile ``emit`` and ``show`` alone write to standard output; what else is printed goes to standard error."""
    before = _RESULTS.set((_results(),))
    try:
        with redirect_stdout(_aside()):
            yield
    finally:
        _RESULTS.reset(before)


_RESULTS: ContextVar[tuple[TextIO | None] | None] = ContextVar("results", default=None)
"""Where results go while ``sys.stdout`` leads elsewhere; None in it: standard output is closed."""


def _results() -> TextIO | None:
    reserved = _RESULTS.get()
    return sys.stdout if reserved is None else reserved[0]


def _aside() -> TextIO | None:
    """Another stream to standard error, which may be closed without harm."""
    try:
        return os.fdopen(sys.stderr.fileno(), "w", 1, encoding=sys.stderr.encoding, errors="replace", closefd=False)
    except (AttributeError, io.UnsupportedOperation):  # there is none, or it is no file
        return sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123 - os.devnull is no path everywhere


def _open_standard_streams() -> None:
    """Have descriptors 0 to 2 lead somewhere: of one that is closed, the next file that is opened would have the number."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(descriptor, True)
    os.close(descriptor)


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
    except ValueError:  # somebody has closed it
        return
    except BrokenPipeError:
        leave(stream)
    except OSError as error:
        leave(stream)
        _complain(error)


def _complain(error: OSError) -> None:
    from phframe.core.errors import InputError

    raise InputError(f"cannot write the output: {(error.strerror or str(error)).lower()}") from None
