"""Asks distributions what they offer, each in a process of its own that is bounded in time and memory, several at once."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from phframe.core.distributions import PluginDistribution
from phframe.registry.answer import MOST_BYTES, Answer, from_json

MEMORY = 2 << 30
"""That a distribution may use to answer (bytes)."""
_NAMES_SECONDS = 30.0
"""That a suite of scenes may take to tell their names; it imports more."""
_AT_ONCE = max(1, min(4, os.cpu_count() or 1))
_LOOK_AGAIN = 0.004  # seconds
_ASK = (
    "import json, sys; request = json.loads(sys.argv[1]); sys.path[:] = request['path']; "
    "from phframe.registry.answering import main; main(request)"
)
_ALONE = {
    "PHFRAME_PLUGINS": "",
    "PYDANTIC_DISABLE_PLUGINS": "__all__",
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
}
"""Of the environment: one that asks for the catalogue itself asks nobody, and memory is not spent on threads."""


def ask_all(asked: Sequence[PluginDistribution], seconds: float, memory: int = MEMORY) -> list[Answer]:
    """What each distribution offers, in their order. None of their code runs in this process.

    Args:
        asked: The distributions.
        seconds: That each may take (wall time).
        memory: That each may use (bytes).
    """
    return _all([{"hooks": each.hooks, "seconds": seconds, "memory": memory} for each in asked])


def ask_scene_names(suites: Sequence[str]) -> list[Answer]:
    """The names of the scenes of suites, made with the options that they have by default, in their order.

    Args:
        suites: Each as ``module:Class``.
    """
    return _all([{"suite": each, "seconds": _NAMES_SECONDS, "memory": MEMORY} for each in suites])


def _all(requests: Sequence[Mapping[str, Any]]) -> list[Answer]:
    answers: dict[int, Answer] = {}
    waiting = list(enumerate(requests))[::-1]
    running: dict[int, _Conversation] = {}
    with tempfile.TemporaryDirectory(prefix="phframe-", ignore_cleanup_errors=True) as folder, _ended(running):
        while waiting or running:
            while waiting and len(running) < _AT_ONCE:
                number, each = waiting.pop()
                running[number] = _Conversation(each, Path(folder, str(number)))
            for number in [number for number, each in running.items() if each.is_over()]:
                answers[number] = running.pop(number).answer()
            time.sleep(_LOOK_AGAIN if running else 0)
    return [answers[number] for number in range(len(requests))]


class _Conversation:
    """One distribution being asked."""

    def __init__(self, request: Mapping[str, Any], folder: Path) -> None:
        folder.mkdir()
        self._file, self._seconds = folder / "answer.json", request["seconds"]
        told = {**request, "answer": str(self._file), "path": _path()}
        self._until = time.monotonic() + self._seconds
        nothing = subprocess.DEVNULL
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _ASK, json.dumps(told)],
            stdin=nothing, stdout=nothing, stderr=nothing, cwd=folder, env={**os.environ, **_ALONE}, start_new_session=True,
        )  # fmt: skip

    def is_over(self) -> bool:
        """Whether there is no more to wait for."""
        return self._process.poll() is not None or self._file.is_file() or time.monotonic() > self._until

    def answer(self) -> Answer:
        """What was answered; the process and what it has started end now."""
        code = self._process.poll()
        self.end()
        if not self._file.is_file():
            return self._silence(code)
        with self._file.open("rb") as file:
            return from_json(file.read(MOST_BYTES + 1))

    def end(self) -> None:
        """End the process, and what it has started. It may have ended already."""
        with suppress(OSError):
            getattr(os, "killpg", os.kill)(self._process.pid, getattr(signal, "SIGKILL", signal.SIGTERM))
        self._process.kill()
        self._process.wait()

    def _silence(self, code: int | None) -> Answer:
        if code is None:
            return Answer(error=f"asked what it offers, it gave no answer within {self._seconds:g} s", hasty=True)
        how = f"with exit code {code}" if code >= 0 else f"by the signal {_signal(-code)}"
        return Answer(error=f"asked what it offers, it ended the process {how}")


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return str(number)


def _path() -> list[str]:
    """Where modules are looked for: as here, but not in the working directory, whichever it is; phframe itself at the end."""
    home = str(Path(__file__).parents[2])
    path = [os.path.abspath(str(each)) for each in sys.path if each]  # noqa: PTH100 - not resolved
    return path if home in path else [*path, home]


@contextmanager
def _ended(running: Mapping[int, _Conversation]) -> Iterator[None]:
    try:
        yield
    finally:
        for each in running.values():
            each.end()
