"""MuJoCo's warnings as something to act on, instead of lines on the screen and in a file ``MUJOCO_LOG.TXT``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import mujoco


@contextmanager
def caught_warnings() -> Iterator[list[str]]:
    """Collects what MuJoCo warns of in this block; the handler is the process's own, and is put back afterwards."""
    found: list[str] = []
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(found.append)
    try:
        yield found
    finally:
        mujoco.set_mju_user_warning(before)
