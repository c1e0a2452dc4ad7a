"""Many recorded solves in one process, in every engine: neither threads, nor open files, nor memory grow."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.trials import many, tried

pytestmark = [
    pytest.mark.slow,
    pytest.mark.needs_rerun,
    pytest.mark.skipif(sys.platform != "linux", reason="Linux says what a process has"),
]
SOLVES = """
import json, os, sys
from pathlib import Path
import phframe
from phframe.recorders.rerun_ import RerunRecorder

def has():
    resident = int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20
    return len(os.listdir("/proc/self/task")), len(os.listdir("/proc/self/fd")), resident

def solve():
    episode = phframe.solve("vieira/simple-07", backend=sys.argv[1], observers=[RerunRecorder(Path(sys.argv[2]))])
    assert episode.status.is_success, episode.reason

number, found = int(sys.argv[3]), []
for _ in range(number):
    solve()
    found.append(has())
print(json.dumps(found))
"""
NUMBERS = {"pymunk": 10, "fast": 10, "mujoco": 5, "pybullet": 5}
"""Solves in one process, by engine; some are slower."""
WARM, MOST_GROWTH = 3, 24.0
"""Solves until all is loaded that ever will be, and what memory may grow by from then on, whatever the number (MB)."""


@pytest.mark.parametrize(
    "backend",
    [
        "pymunk",
        pytest.param("fast", marks=pytest.mark.needs_fast),
        pytest.param("mujoco", marks=pytest.mark.needs_mujoco),
        pytest.param("pybullet", marks=pytest.mark.needs_pybullet),
    ],
)
def test_many_recorded_solves_take_no_more_than_few(backend: str, tmp_path: Path) -> None:
    for library in ("rerun", {"fast": "numba"}.get(backend, backend)):
        pytest.importorskip(library)
    number = many(NUMBERS[backend])
    command = [sys.executable, "-c", SOLVES, backend, str(tmp_path / "one.rrd"), str(number)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=3600)
    tried(f"recorded solves in one process: {backend}", number)
    threads, files, memory = zip(*json.loads(done.stdout), strict=True)
    assert max(threads[WARM:]) <= threads[WARM]
    assert max(files[WARM:]) <= files[WARM]
    assert memory[-1] - memory[WARM] <= MOST_GROWTH
