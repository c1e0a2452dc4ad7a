"""Draws pictures of a MuJoCo model with no screen: by EGL, or in software by OSMesa.

MuJoCo's own Renderer takes its OpenGL from the environment variable ``MUJOCO_GL`` as it was when mujoco was imported,
and without it wants a display on Linux; here what is installed is taken.
"""

from __future__ import annotations

import os
import sys
from ctypes.util import find_library
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from phframe.core import InputError

Picture = NDArray[np.uint8]
SETTING = "MUJOCO_GL"
LIBRARIES = {"egl": ("EGL", "libegl1"), "osmesa": ("OSMesa", "libosmesa6")}
"""What may draw on Linux: the shared library, and Debian's package."""
MOST_GEOMS = 2000


class Offscreen:
    """A frame of fixed size that pictures are drawn in. Close it.

    Args:
        model: A MuJoCo model; its off-screen buffer is as large as the picture.
        width: Of the pictures (pixels).
        height: Of the pictures (pixels).

    Raises:
        InputError: If nothing here can draw; says what to install or set.
    """

    def __init__(self, model: Any, width: int, height: int) -> None:
        self._model, self._rect = model, mujoco.MjrRect(0, 0, width, height)
        self._gl: Any = open_gl(width, height)
        self._gl.make_current()
        self._scene = mujoco.MjvScene(model, maxgeom=MOST_GEOMS)
        self._context: Any = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._pixels = np.zeros((height, width, 3), dtype=np.uint8)

    def draw(self, data: Any, camera: Any, caption: tuple[str, str] = ("", "")) -> Picture:
        """What the camera sees, ``(height, width, 3)`` red, green and blue; a caption in two columns at the top left."""
        option, perturbation, everything = mujoco.MjvOption(), mujoco.MjvPerturb(), mujoco.mjtCatBit.mjCAT_ALL
        self._gl.make_current()
        mujoco.mjv_updateScene(self._model, data, option, perturbation, camera, everything, self._scene)
        mujoco.mjr_render(self._rect, self._scene, self._context)
        if any(caption):
            font, corner = mujoco.mjtFont.mjFONT_NORMAL, mujoco.mjtGridPos.mjGRID_TOPLEFT
            mujoco.mjr_overlay(font, corner, self._rect, *(_plain(text) for text in caption), self._context)
        mujoco.mjr_readPixels(self._pixels, None, self._rect, self._context)
        return np.ascontiguousarray(self._pixels[::-1])

    def close(self) -> None:
        """Give the graphics memory back. May be called twice."""
        if self._gl is not None:
            self._gl.make_current()
            self._context.free()
            self._gl.free()
            self._gl = None


def open_gl(width: int, height: int) -> Any:
    """Somewhere to draw. Free it.

    Raises:
        InputError: If nothing here can draw; says what to install or set.
    """
    wanted = _wanted()
    try:
        return _context_type(wanted)(width, height)
    except (ImportError, RuntimeError, AttributeError, OSError) as error:  # what MuJoCo and PyOpenGL raise without GL
        why = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"cannot draw pictures with {wanted or 'OpenGL'}: {why}. {_advice(wanted)}") from None


def _wanted() -> str:
    """What the environment says, else on Linux what is installed; empty: what MuJoCo takes on this system."""
    given = os.environ.get(SETTING, "").strip().lower()
    if given or not sys.platform.startswith("linux"):
        return given
    for name, (library, _) in LIBRARIES.items():
        if find_library(library) is not None:
            return name
    raise InputError(f"cannot draw pictures: neither EGL nor OSMesa is installed. {_advice('')}")


def _context_type(wanted: str) -> Any:
    if wanted == "egl":
        from mujoco.egl import GLContext
    elif wanted == "osmesa":
        from mujoco.osmesa import GLContext
    else:
        from mujoco.gl_context import GLContext
    return GLContext


def _advice(wanted: str) -> str:
    if not sys.platform.startswith("linux"):
        return f"Set {SETTING} to what this system has."
    other = "osmesa" if wanted == "egl" else "egl"
    packages = " or ".join(package for _, package in LIBRARIES.values())
    return f"Install one of them (Debian: {packages}), or set {SETTING}={other}."


def _plain(text: str) -> str:
    """The font has no other letters."""
    return text.encode("ascii", "replace").decode("ascii")
