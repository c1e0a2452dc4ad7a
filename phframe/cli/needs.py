"""Libraries that a command needs and that a plain installation lacks."""

from __future__ import annotations

import importlib.util


def require(module: str, what: str, extra: str) -> None:
    """Make sure that a library is there before anything is begun.

    Args:
        module: What is imported.
        what: What needs it.
        extra: Of phframe, that brings it.

    Raises:
        NotInstalledError: If it is not installed.
    """
    if importlib.util.find_spec(module) is not None:
        return
    from phframe.core.errors import NotInstalledError
    from phframe.registry.requirements import missing

    gap = missing("phframe", extra)
    remedy = gap.remedy if gap else f'pip install "phframe[{extra}]"'
    raise NotInstalledError(what, module, remedy)
