"""An exception as one line and an exit code."""

from __future__ import annotations

import os
import sys
import tempfile
import traceback
from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any

from phframe.cli.console import leave, note
from phframe.cli.exit_codes import ExitCode

DEBUG = "PHFRAME_DEBUG"
"""Environment variable: 1 shows the traceback of every error."""


def report(error: BaseException) -> int:
    """Say in one line on standard error what went wrong.

    Returns:
        The exit code.
    """
    if isinstance(error, BrokenPipeError):
        leave(sys.stdout)
        return ExitCode.SUCCESS
    if os.environ.get(DEBUG) == "1":
        note("".join(traceback.format_exception(error)).rstrip())
    (text, code), notes = _described(error), getattr(error, "__notes__", ())
    note(f"error: {_in_a_line('; '.join([text.rstrip('.') if notes else text, *notes]))}")
    return code


def _described(error: BaseException) -> tuple[str, int]:
    if hasattr(error, "format_message"):  # of the option parser
        return _usage(error), ExitCode.BAD_INPUT
    if isinstance(error, MemoryError):
        return "it ran out of memory", ExitCode.OTHER_OUTCOME
    from phframe.core.errors import (
        BudgetExceededError,
        NotInstalledError,
        PartFailedError,
        PhframeError,
        SimulationDivergedError,
        error_text,
    )

    if isinstance(error, NotInstalledError):
        return str(error), ExitCode.NOT_INSTALLED
    if isinstance(error, (SimulationDivergedError, BudgetExceededError)):
        return str(error), ExitCode.OTHER_OUTCOME
    if isinstance(error, PartFailedError):
        return f"{error} ({_place_of_traceback(error)})", ExitCode.BAD_INPUT
    if isinstance(error, PhframeError):
        return str(error), ExitCode.BAD_INPUT
    return f"internal: {error_text(error)} ({_place_of_traceback(error)})", ExitCode.INTERNAL_ERROR


def _usage(error: Any) -> str:
    """What the option parser complains of, what was meant, and where to read on."""
    possible = getattr(error, "possibilities", None)
    text = error.message if possible else error.format_message()
    sentence = _in_a_line(text[:1].lower() + text[1:]).rstrip(".")
    meant = f" Did you mean {_closest(error.option_name, possible)!r}?" if possible else ""
    context = getattr(error, "ctx", None)
    command = context.command_path if context else "phframe"
    end = "" if sentence.endswith("?") else "."
    return f"{sentence}{end}{meant} See '{command} --help'."


def _closest(name: str, possible: Sequence[str]) -> str:
    return (get_close_matches(name, possible, n=1, cutoff=0.0) or list(possible))[0]


def _in_a_line(text: str) -> str:
    return " ".join(text.split())


def _place_of_traceback(error: BaseException) -> str:
    if os.environ.get(DEBUG) == "1":
        return "the traceback is above"
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="phframe-error-", suffix=".txt", delete=False, encoding="utf-8"
        ) as file:
            file.write("".join(traceback.format_exception(error)))
    except OSError:
        return f"set {DEBUG}=1 to see the traceback"
    return f"the traceback is in {file.name}; {DEBUG}=1 shows it"
