"""Opens a saved recording in Rerun's own viewer, in a process of its own."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

from phframe.core import InputError, NotInstalledError


def require_viewer(path: Path) -> None:
    """Check that the viewer can be opened here; worth asking before a long run.

    Args:
        path: The recording, for the message.

    Raises:
        NotInstalledError: If rerun is not installed.
        InputError: If there is no display to open a window on; names the command for the web viewer.
    """
    if importlib.util.find_spec("rerun") is None:
        raise NotInstalledError("the viewer", "rerun-sdk", "Install it with: pip install 'phframe[rerun]'")
    if not _has_display():
        raise InputError(
            "the viewer cannot open a window: there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set). "
            f"To look at the recording in a browser, run: {web_viewer_command(path)}"
        )


def open_viewer(path: Path) -> subprocess.Popen[bytes]:
    """Open a saved recording in a window that outlives this process.

    Args:
        path: The recording.

    Returns:
        The viewer's process; there is no need to wait for it.

    Raises:
        NotInstalledError: If rerun is not installed.
        InputError: If there is no such file, or no display to open a window on.
    """
    if not path.is_file():
        raise InputError(f"there is no recording {path}")
    require_viewer(path)
    nowhere = subprocess.DEVNULL
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "rerun", str(path)],
        stdin=nowhere,
        stdout=nowhere,
        stderr=nowhere,
        start_new_session=True,
    )


def web_viewer_command(path: Path) -> str:
    """The line that shows a recording in a browser, at the address it prints."""
    return f"{sys.executable} -m rerun --serve-web {path}"


def _has_display() -> bool:
    """Only on Linux and its like can there be none."""
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
