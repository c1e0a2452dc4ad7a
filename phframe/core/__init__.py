"""The language of phframe: data types, the abstract interfaces, Task and the errors. Depends on nothing else of ours.

What it names, listed in ``everything``, is loaded when it is first used: whoever needs no more than the errors, such as a
listing, does not wait for numerical libraries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from phframe.core.everything import *  # noqa: F403 - its __all__ lists them


def __getattr__(name: str) -> Any:
    if name == "everything" or (name.startswith("__") and name != "__all__"):
        raise AttributeError(f"module 'phframe.core' has no attribute {name!r}")
    from phframe.core import everything

    try:
        return globals().setdefault(name, getattr(everything, name))
    except AttributeError:
        raise AttributeError(f"module 'phframe.core' has no attribute {name!r}") from None
