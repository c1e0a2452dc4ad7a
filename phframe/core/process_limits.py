"""Limits on what this process may take, and its end with that of its parent, where the system has such things."""

from __future__ import annotations

import signal
import sys
from contextlib import suppress

_PR_SET_PDEATHSIG = 1


def limit_process(**limits: int) -> None:
    """Limit this process; a lower limit of the user's stays.

    Args:
        limits: By the names that ``resource`` has for them, in its units, such as ``RLIMIT_CORE=0``.
    """
    try:
        import resource
    except ImportError:  # Windows has none
        return
    for name, wanted in limits.items():
        with suppress(ValueError, OSError):  # macOS may refuse
            what = getattr(resource, name)
            _, most = resource.getrlimit(what)
            resource.setrlimit(what, (wanted if most < 0 else min(wanted, most), most))


def end_with_parent() -> bool:
    """Have this process killed when its parent ends, however that ends; whether the system can do so, as Linux can.

    A parent that has ended before this is not noticed: see to it afterwards.
    """
    if sys.platform != "linux":
        return False
    import ctypes

    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
    return True
