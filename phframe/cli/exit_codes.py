"""What the command's exit code says."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """How a command ended."""

    SUCCESS = 0
    """Done; for ``solve``: the target was retrieved."""
    OTHER_OUTCOME = 1
    """``solve`` ran to its end and the target was not retrieved; ``bench``: some trials gave no episode; a replay differs."""
    BAD_INPUT = 2
    """Bad input or usage, or a plugin that failed."""
    NOT_INSTALLED = 3
    """Something that is needed is not installed."""
    INTERNAL_ERROR = 70
    """A mistake in phframe."""
    INTERRUPTED = 130
    """Ended by Ctrl-C, SIGTERM or SIGHUP."""


MEANING = {
    ExitCode.SUCCESS: "done; for `solve`: the target was retrieved",
    ExitCode.OTHER_OUTCOME: "`solve` ran to its end and the target was not retrieved; `bench`: some trials crashed, were killed, "
    "ran out of memory or had an error; `replay`, `bench replay`: not the same",
    ExitCode.BAD_INPUT: "bad input or usage, or a plugin that failed",
    ExitCode.NOT_INSTALLED: "something that is needed is not installed",
    ExitCode.INTERNAL_ERROR: "an internal error",
    ExitCode.INTERRUPTED: "ended by Ctrl-C, SIGTERM or SIGHUP; what was recorded is kept",
}
"""The same for people."""
