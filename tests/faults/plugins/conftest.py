"""The command line in a process of its own, with what a test has installed on its path, and nothing of this process."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.faults.plugins.hostile import Hostile
from tests.trials import tried

ROOT = Path(__file__).parents[3]
MOST = 300
"""Seconds after which a command is taken to hang."""


@dataclass(frozen=True)
class Bench:
    """A folder to run commands in.

    Attributes:
        folder: Of everything.
        environment: Of the commands.
    """

    folder: Path
    environment: Mapping[str, str] = field(default_factory=dict)

    @property
    def site(self) -> Path:
        return self.folder / "site"

    @property
    def work(self) -> Path:
        """The working directory."""
        return self.folder / "work"

    @property
    def ran(self) -> set[str]:
        """The modules of plugins that have run."""
        return {path.name for path in (self.folder / "ran").iterdir()}

    def pids(self, module: str) -> list[int]:
        """Of the processes in which a module has run."""
        path = self.folder / "ran" / module
        return [int(line) for line in path.read_text().split()] if path.exists() else []

    def forget(self) -> None:
        """As if nothing had run."""
        for path in (self.folder / "ran").iterdir():
            path.unlink()

    def install(self, *kinds: Hostile) -> None:
        for kind in kinds:
            kind.install(self.site)

    @property
    def surroundings(self) -> dict[str, str]:
        """The environment variables of a command."""
        cleared = {key: value for key, value in os.environ.items() if not key.startswith("PHFRAME_")}
        paths = {"PYTHONPATH": os.pathsep.join([str(self.site), str(ROOT)]), "RAN": str(self.folder / "ran")}
        own = {"PHFRAME_CACHE": str(self.folder / "cache"), "TMPDIR": str(self.folder / "tmp"), "COLUMNS": "400"}
        return {**cleared, **paths, **own, **self.environment}

    def popen(self, *arguments: str, **environment: str) -> subprocess.Popen[str]:
        return self._started([sys.executable, "-m", "phframe", *arguments], environment)

    def run(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return self._ended(self.popen(*arguments, **environment))

    def shell(self, line: str) -> subprocess.CompletedProcess[str]:
        """Run a command with what a shell understands, such as ``>&-``."""
        return self._ended(self._started(["sh", "-c", f"exec {sys.executable} -m phframe {line}"], {}))

    def _started(self, command: list[str], environment: Mapping[str, str]) -> subprocess.Popen[str]:
        if any(self.site.iterdir()) or any(self.work.iterdir()):
            tried("processes: a command with hostile plugins about")
        return subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=self.work,
            env={**self.surroundings, **environment},
        )

    def _ended(self, process: subprocess.Popen[str]) -> subprocess.CompletedProcess[str]:
        with process:
            try:
                out, err = process.communicate(timeout=MOST)
            finally:
                process.kill()
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def made(folder: Path, kinds: Iterable[Hostile] = (), **environment: str) -> Bench:
    """A new one in an empty folder, with some distributions installed."""
    for name in ("site", "work", "ran", "tmp"):
        (folder / name).mkdir()
    bench = Bench(folder, environment)
    bench.install(*kinds)
    return bench


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    """With nothing installed."""
    return made(tmp_path)


def is_alive(pid: int) -> bool:
    """Whether a process runs, and is no more than a zombie."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state not in "ZX"
