"""Where the commands write to: results to standard output, everything else to standard error.

Whatever is written is printable here, and messages are short here: nobody else has to see to it.
"""

from __future__ import annotations

import os
import sys
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
    _write(sys.stdout, printable(text))


def deliver(text: str) -> None:
    """The result, as a document for other programs: letter by letter what a file would hold, unless a terminal shows it."""
    shown = sys.stdout is not None and sys.stdout.isatty()
    _write(sys.stdout, printable(text) if shown else text)


def show(what: RenderableType) -> None:
    """The result, as a table or another picture of it."""
    from phframe.cli.rich_console import PrintableConsole

    console = PrintableConsole(highlight=False)
    if not console.is_terminal:
        console.width = _columns()
    with console.capture() as capture:
        console.print(what)
    _write(sys.stdout, "\n".join(line.rstrip() for line in capture.get().rstrip("\n").split("\n")))


def error_console() -> Console:
    """Standard error, for progress."""
    from phframe.cli.rich_console import PrintableConsole

    return PrintableConsole(stderr=True, highlight=False)


def leave(stream: TextIO) -> None:
    """Let what is still to be written to a stream that takes no more vanish."""
    with open(os.devnull, "wb") as nowhere:  # noqa: PTH123 - os.devnull is no path on every system
        os.dup2(nowhere.fileno(), stream.fileno())


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
