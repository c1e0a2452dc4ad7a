"""Screenshot of a recording in Rerun's web viewer, by headless Chromium, driven over the DevTools protocol.

``python -m docs.screenshot recording.rrd picture.png --theme light --at 0.3``
"""

from __future__ import annotations

import argparse
import base64
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from docs.chromium import CHROMIUM, ChromiumPage, find_chromium

WIDTH, HEIGHT = 1760, 1044
TIMELINE = 0.167, 0.8825
"""Where the collapsed time panel's line begins and ends, in fractions of the width."""
DRAWN, STEADY = 40, 5
"""Seconds: before the viewer has drawn in software, and between two looks."""
LOOKS, MOST = 3, 40
"""How many looks must see the same, and after how many it is given up."""
TOP, PANEL = 36, 32
"""Height of the viewer's own bar, which is cut off, and of the collapsed time panel (pixels)."""


def take(recording: Path, picture: Path, theme: str = "dark", at: float = 0.0) -> None:
    """Photograph a recording.

    Args:
        recording: The ``.rrd`` file.
        picture: The ``.png`` file; replaced.
        theme: ``dark`` or ``light``.
        at: The moment, as a fraction of the recording's time.

    Raises:
        RuntimeError: If there is no Chromium, or it does not come to rest.
    """
    browser = find_chromium()
    if browser is None:
        raise RuntimeError(f"no Chromium: none of {', '.join(CHROMIUM)} is installed")
    with _served(recording) as address, _Viewer(browser, WIDTH, HEIGHT) as page:
        page.open(f"{address}&renderer=webgl&hide_welcome_screen=1&theme={theme}")
        time.sleep(DRAWN)
        low, high = TIMELINE
        picture.write_bytes(page.at_rest(WIDTH * (low + at * (high - low))))


@contextmanager
def _served(recording: Path) -> Iterator[str]:
    """The recording behind a web server; its address."""
    web, data = _free_port(), _free_port()
    command = [sys.executable, "-m", "rerun", "--serve-web", "--web-viewer-port", str(web), "--port", str(data)]
    server = subprocess.Popen(
        [*command, str(recording)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        _await_port(web)
        yield f"http://127.0.0.1:{web}/?url=rerun%2Bhttp://127.0.0.1:{data}/proxy"
    finally:
        os.killpg(server.pid, signal.SIGTERM)  # the module starts the server as a process of its own
        server.wait()


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


def _await_port(port: int) -> None:
    for _ in range(300):
        with socket.socket() as one:
            if one.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise RuntimeError("the web viewer does not start")


class _Viewer(ChromiumPage):
    """The page with Rerun's viewer."""

    def open(self, address: str) -> None:
        """Go to an address."""
        self.do("Emulation.setDeviceMetricsOverride", width=WIDTH, height=HEIGHT, deviceScaleFactor=1, mobile=False)
        self.do("Page.navigate", url=address)

    def drag(self, x: float, y: float) -> None:
        """With the left button, a little to the right, up to pixels from the top left; then away from everything."""
        for kind, before in (("mouseMoved", 12), ("mousePressed", 12), ("mouseMoved", 6), ("mouseMoved", 0)):
            self._mouse(kind, x - before, y)
            time.sleep(0.3)
        self._mouse("mouseReleased", x, y)
        self._mouse("mouseMoved", WIDTH / 2, 2.0)

    def _mouse(self, kind: str, x: float, y: float) -> None:
        button = {} if kind == "mouseMoved" else {"button": "left", "clickCount": 1}
        self.do("Input.dispatchMouseEvent", type=kind, x=x, y=y, buttons=1, **button)

    def at_rest(self, moment: float) -> bytes:
        """The picture (PNG) when the time is dragged to so many pixels, which pauses, once several looks in a row see the same.

        Raises:
            RuntimeError: If it goes on changing.
        """
        seen = [b""] * LOOKS
        for _ in range(MOST):
            self.drag(moment, HEIGHT - PANEL / 2)  # again and again: at first there may be no timeline yet
            time.sleep(STEADY)
            seen = [*seen[1:], self._picture(HEIGHT - TOP - PANEL)]  # the time panel never quite comes to rest
            if len(set(seen)) == 1:
                return self._picture(HEIGHT - TOP)
        raise RuntimeError("the viewer does not come to rest")

    def _picture(self, height: int) -> bytes:
        """What there is below the viewer's own bar (PNG)."""
        clip = {"x": 0, "y": TOP, "width": WIDTH, "height": height, "scale": 1}
        return base64.b64decode(self.do("Page.captureScreenshot", format="png", clip=clip)["data"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording", type=Path)
    parser.add_argument("picture", type=Path)
    parser.add_argument("--theme", choices=["dark", "light"], default="dark")
    parser.add_argument("--at", type=float, default=0.0)
    take(**vars(parser.parse_args()))
