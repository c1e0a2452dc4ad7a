"""Which OpenGL there is to draw with where there is no screen. It is asked before mujoco is imported.

MuJoCo takes its OpenGL from the environment variable ``MUJOCO_GL`` as it is when mujoco is imported, and then wants it to
be there; without the variable it wants a display on Linux. Here what is installed is taken.
"""

from __future__ import annotations

import os
import sys
from ctypes import CDLL
from ctypes.util import find_library

from phframe.core import InputError

SETTING = "MUJOCO_GL"
LIBRARIES = {"egl": ("EGL", "libegl1"), "osmesa": ("OSMesa", "libosmesa6")}
"""What draws without a screen on Linux, by what MuJoCo calls it: the shared library, and Debian's package."""
SCREENS = ("glfw", "glx", "wgl", "cgl", "enable", "enabled", "on", "true", "1")
"""Other settings that MuJoCo understands and that draw."""


def find_opengl() -> str:
    """``egl`` or ``osmesa`` or another that the environment asks for; empty: what MuJoCo takes where there is a screen.

    Raises:
        InputError: If there is nothing to draw with; says what to install or set.
    """
    given = os.environ.get(SETTING, "").strip().lower()
    if given and given not in (*LIBRARIES, *SCREENS):
        raise InputError(f"cannot draw pictures: {SETTING} is {given!r}. Set it to egl or osmesa, or do not set it.")
    if given in SCREENS or not sys.platform.startswith("linux"):
        return given
    wanted = [given] if given else list(LIBRARIES)
    for name in wanted:
        if _is_there(LIBRARIES[name][0]):
            return name
    libraries = " nor ".join(LIBRARIES[name][0] for name in wanted)
    raise InputError(f"cannot draw pictures: {libraries} is not installed. {advice(given)}")


def _is_there(library: str) -> bool:
    if find_library(library) is not None:
        return True
    try:  # where only the loader's own path leads to it
        CDLL(f"lib{library}.so")
    except OSError:
        return False
    return True


def advice(failed: str) -> str:
    """What to do where something did not draw."""
    if not sys.platform.startswith("linux"):
        return f"Set {SETTING} to what this system has."
    packages = " or ".join(package for name, (_, package) in LIBRARIES.items())
    other = "osmesa" if failed == "egl" else "egl"
    return f"Install {packages} (Debian's names), or set {SETTING}={other}."
