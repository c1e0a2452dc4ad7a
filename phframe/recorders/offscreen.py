"""Draws pictures of a MuJoCo model with no screen: by EGL, or in software by OSMesa."""

from __future__ import annotations

import warnings
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from phframe.core import InputError
from phframe.recorders.opengl import advice, find_opengl

Picture = NDArray[np.uint8]
MOST_GEOMS = 2000
NO_OPENGL = (mujoco.FatalError, ImportError, RuntimeError, AttributeError, OSError)
"""What MuJoCo and PyOpenGL raise where there is none."""


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
        self._scene = mujoco.MjvScene(model, maxgeom=MOST_GEOMS)
        name = find_opengl()
        try:
            self._open(name)
        except NO_OPENGL as error:
            why = " ".join(str(error).split()).rstrip(".") or type(error).__name__
            raise InputError(f"cannot draw pictures with {name or 'OpenGL'}: {why}. {advice(name)}") from None
        self._pixels = np.zeros((height, width, 3), dtype=np.uint8)

    def _open(self, name: str) -> None:
        with warnings.catch_warnings(action="ignore"):  # of GLFW, which warns and goes on without a window
            self._gl: Any = _open_gl(name, self._rect.width, self._rect.height)
            self._gl.make_current()
        self._context: Any = mujoco.MjrContext(self._model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)

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


def require_drawing() -> None:
    """Check that pictures can be drawn here, by drawing one of nothing.

    Raises:
        InputError: If not; says what to install or set.
    """
    model = mujoco.MjSpec().compile()
    screen = Offscreen(model, 16, 16)
    screen.draw(mujoco.MjData(model), mujoco.MjvCamera())
    screen.close()


def _open_gl(name: str, width: int, height: int) -> Any:
    if name == "egl":
        from mujoco.egl import GLContext
    elif name == "osmesa":
        from mujoco.osmesa import GLContext
    else:
        from mujoco.gl_context import GLContext
    return GLContext(width, height)


def _plain(text: str) -> str:
    """The font has no other letters."""
    return text.encode("ascii", "replace").decode("ascii")
