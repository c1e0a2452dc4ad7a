"""Modules that lie about in the working directory are not run, here or in processes that are started."""

from __future__ import annotations

import pytest

from tests.faults.plugins.conftest import Bench
from tests.faults.plugins.hostile import Hostile

pytestmark = pytest.mark.slow

NAMES = (
    "numpy",
    "scipy",
    "typer",
    "rerun",
    "pydantic",
    "multiprocessing",
    "socket",
    "pickle",
    "json",
    "lab_good_class",
)


@pytest.mark.parametrize(
    "command",
    [
        ("solve", "vieira/simple-07", "--planner", "phis", "--workers", "2", "--no-rerun", "--json"),
        ("bench", "run", "vieira/simple-07", "--planner", "ooa", "--out", "bench", "--quiet"),
        ("planners", "--json"),
    ],
    ids=lambda command: command[0],
)
def test_they_are_not_run(bench: Bench, command: tuple[str, ...]) -> None:
    bench.install(Hostile("lab-good", None))
    for name in NAMES:
        (bench.work / f"{name}.py").write_text(f"import os; open(os.environ['RAN'] + '/local-{name}', 'w')")
    done = bench.run(*command)
    assert (done.returncode, done.stderr) == (0, "")
    assert bench.ran <= {"lab_good"}
