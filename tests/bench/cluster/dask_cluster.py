"""A Dask cluster of processes on this machine, started as a user would start it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from phframe.bench.environment import Environment

ROOT = Path(__file__).parents[3]
VERSION = "PHFRAME_TEST_VERSION"
_BEGINNINGS = {"scheduler": "Scheduler at:", "worker": "Registered to:"}


def look() -> Environment:
    """Where this process runs: a version that the tests can choose for workers."""
    return Environment({"phframe": os.environ.get(VERSION, "1")}, cpu=str(os.getpid()))


@dataclass
class DaskCluster:
    """The scheduler and workers of a test.

    Attributes:
        folder: For their logs and files.
        address: Of the scheduler.
        workers: Their processes.
    """

    folder: Path
    address: str = ""
    scheduler: subprocess.Popen[bytes] | None = None
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def start_scheduler(self) -> None:
        """Start the scheduler and wait until it listens."""
        self.scheduler, log = self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        line = next(line for line in log.splitlines() if "Scheduler at:" in line)
        self.address = line.split()[-1]

    def start_worker(self, *flags: str, **environment: str) -> subprocess.Popen[bytes]:
        """Start a worker of one thread and wait until the scheduler has it."""
        flags = flags or ("--no-nanny",)
        common = ("--nthreads", "1", "--no-dashboard", "--local-directory", str(self.folder), "--death-timeout", "60")
        process, _ = self._start("worker", self.address, *common, *flags, **environment)
        self.workers.append(process)
        return process

    def _start(self, what: str, *flags: str, **environment: str) -> tuple[subprocess.Popen[bytes], str]:
        log = self.folder / f"{what}{len(self.workers)}.log"
        with log.open("wb") as stream:
            process = subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.dask_{what}", *flags],
                stdout=stream,
                stderr=stream,
                cwd=self.folder,
                env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
            )
        for _ in range(6000):
            text = log.read_text()
            if _BEGINNINGS[what] in text:
                return process, text
            assert process.poll() is None, text
            time.sleep(0.01)
        pytest.fail(text)

    def close(self) -> None:
        """End all."""
        for process in filter(None, (*self.workers, self.scheduler)):
            process.send_signal(signal.SIGTERM)
        for process in filter(None, (*self.workers, self.scheduler)):
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


@contextmanager
def dask_cluster(folder: Path, workers: int) -> Iterator[DaskCluster]:
    """A cluster with that many workers."""
    cluster = DaskCluster(folder)
    try:
        cluster.start_scheduler()
        for _ in range(workers):
            cluster.start_worker()
        yield cluster
    finally:
        cluster.close()
