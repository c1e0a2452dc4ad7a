"""Running the commands: in this process, as a process of their own, and with plugins installed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from textwrap import dedent
from typing import IO

import pytest
from typer.testing import CliRunner, Result

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.session import BenchSession
from phframe.cli.main import app
from phframe.registry import catalogue
from tests.bench.benches import settings

ROOT = Path(__file__).parents[2]
HEADER = "from phframe.registry import Extension, Kind, hookimpl\n"

Invoke = Callable[..., Result]
Spawn = Callable[..., subprocess.Popen[str]]
Run = Callable[..., subprocess.CompletedProcess[str]]
Install = Callable[..., None]


@pytest.fixture(autouse=True)
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty current directory, to see what a command leaves there."""
    folder = tmp_path / "workplace"
    folder.mkdir()
    monkeypatch.chdir(folder)
    for name in ("PHFRAME_DEBUG", "PHFRAME_PLUGINS", "PHFRAME_PLUGINS_STRICT"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return folder


@pytest.fixture
def invoke(monkeypatch: pytest.MonkeyPatch) -> Invoke:
    """Run a command in this process."""
    monkeypatch.setenv("COLUMNS", "200")
    return lambda *args: CliRunner().invoke(app, [str(arg) for arg in args], prog_name="phframe")


@pytest.fixture
def spawn(tmp_path: Path) -> Iterator[Spawn]:
    """Start a command as a process of its own."""
    started: list[subprocess.Popen[str]] = []

    def spawn(
        *args: object,
        stdout: IO[str] | int = subprocess.PIPE,
        program: Sequence[str] = ("-m", "phframe"),
        **environment: str,
    ) -> subprocess.Popen[str]:
        path = os.pathsep.join([str(tmp_path / "site"), str(ROOT)])
        process = subprocess.Popen(
            [sys.executable, *program, *map(str, args)],
            stdout=stdout,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": path, **environment},
            preexec_fn=_listen if os.name == "posix" else None,  # noqa: PLW1509 - no thread holds a lock that it needs
        )
        started.append(process)
        return process

    yield spawn
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate()


def _listen() -> None:
    """Have a process end by the signals that whoever runs the tests may ignore, as ``nohup`` does."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def until(happened: Callable[[], object], alive: subprocess.Popen[str] | None = None) -> None:
    """Wait for something that must happen, however slow the machine; a minute is for what never does."""
    for _ in range(6000):
        if happened():
            return
        assert alive is None or alive.poll() is None, alive.communicate()
        time.sleep(0.01)
    pytest.fail("it did not happen")


@pytest.fixture
def run(spawn: Spawn) -> Run:
    """Run a command as a process of its own."""

    def run(*args: object, **environment: str) -> subprocess.CompletedProcess[str]:
        process = spawn(*args, **environment)
        out, err = process.communicate(timeout=60)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    return run


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Install a distribution whose one module is called like it; this process and those it starts see it."""
    site = tmp_path / "site"
    site.mkdir()
    monkeypatch.syspath_prepend(str(site))
    before = set(sys.modules)

    def install(name: str, source: str = "", *, version: str = "1.0", requires: tuple[str, ...] = ()) -> None:
        module = name.replace("-", "_")
        info = site / f"{module}-{version}.dist-info"
        info.mkdir()
        lines = ["Metadata-Version: 2.1", f"Name: {name}", f"Version: {version}"]
        (info / "METADATA").write_text("\n".join([*lines, *(f"Requires-Dist: {line}" for line in requires)]) + "\n")
        if source:
            (site / f"{module}.py").write_text(HEADER + dedent(source))
            (info / "entry_points.txt").write_text(f"[phframe]\nplugin = {module}\n")
        catalogue.cache_clear()

    catalogue.cache_clear()
    yield install
    catalogue.cache_clear()
    for added in set(sys.modules) - before:
        if added.startswith("lab"):
            del sys.modules[added]


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of the bench ``tests.cli.bench_runs.SMALL``, run undisturbed."""
    folder = tmp_path_factory.mktemp("finished")
    plan = BenchPlan.of(settings("vieira/simple-0[123]", planners=("phia", "ooa")))
    with BenchSession(folder, plan) as session:
        assert len(list(session.run(range(6), session.local(2)))) == 6
    return folder
