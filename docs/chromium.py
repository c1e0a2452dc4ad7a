"""One page of headless Chromium, driven over the DevTools protocol through two pipes."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from typing import Any, Self

CHROMIUM = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = (
    *("--headless", "--no-sandbox", "--no-first-run", "--disable-quic", "--disable-sync", "--disable-component-update"),
    *("--disable-background-networking", "--remote-debugging-pipe", "--ignore-gpu-blocklist"),
    *("--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
)
"""Alone with the page, draw by software, listen on two pipes."""


def find_chromium() -> str | None:
    """The browser's executable; None: there is none."""
    return next(filter(None, map(shutil.which, CHROMIUM)), None)


class ChromiumPage:
    """One page of Chromium, told what to do over two pipes (descriptors 3 and 4 of the browser).

    Args:
        executable: Of the browser.
        width: Of its window (pixels).
        height: Likewise.

    Attributes:
        events: What the page reported so far: each a method and its parameters.
    """

    def __init__(self, executable: str, width: int, height: int) -> None:
        self.events: list[dict[str, Any]] = []
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        (theirs_in, self._out), (self._in, theirs_out) = os.pipe(), os.pipe()
        command = [executable, *FLAGS, f"--user-data-dir={self._profile.name}", f"--window-size={width},{height}"]
        # The shell moves both pipes to where the browser looks for them.
        script = f'exec "$@" 3<&{theirs_in} 4>&{theirs_out}'
        self._process = subprocess.Popen(
            ["bash", "-c", script, "bash", *command, "about:blank"],
            pass_fds=(theirs_in, theirs_out),
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs_in)
        os.close(theirs_out)
        self._number, self._unread, self._session = 0, b"", ""

    def __enter__(self) -> Self:
        target = self.do("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.do("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.wait()
        os.close(self._in)
        os.close(self._out)
        self._profile.cleanup()

    def do(self, method: str, **parameters: Any) -> Any:
        """Call a method of the DevTools protocol; its result.

        Raises:
            RuntimeError: If it fails, or the browser has ended.
        """
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def await_event(self, method: str) -> dict[str, Any]:
        """The parameters of the next event of a method, of those that came already the first."""
        while not (found := [event for event in self.events if event.get("method") == method]):
            self.events.append(self._read())
        return dict(found[0]["params"])

    def _read(self) -> Any:
        while b"\0" not in self._unread:
            more = os.read(self._in, 1 << 20)
            if not more:
                raise RuntimeError("Chromium has ended")
            self._unread += more
        message, _, self._unread = self._unread.partition(b"\0")
        return json.loads(message)
