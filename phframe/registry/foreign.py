"""Running code of plugins in this process: whatever it raises becomes a ``PluginError``, and the working directory stays."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from phframe.core.errors import PhframeError, PluginError, error_text


@contextmanager
def foreign_code(what: str) -> Iterator[None]:
    """Code of a plugin runs meanwhile. What phframe's own errors say, and Ctrl-C, is passed on as it is.

    Args:
        what: The beginning of the message, such as ``planner 'mine' of mine 1.0 does not load``.

    Raises:
        PluginError: If it raises anything else, were it to end the process.
    """
    before = _working_directory()
    try:
        yield
    except (PhframeError, KeyboardInterrupt):
        raise
    except BaseException as error:
        raise PluginError(f"{what}: {error_text(error)}") from error
    finally:
        if before is not None and _working_directory() != before:
            os.chdir(before)


def _working_directory() -> str | None:
    try:
        return os.getcwd()  # noqa: PTH109 - quicker
    except OSError:  # it has been removed
        return None
