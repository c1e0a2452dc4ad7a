"""Single figures: one persistence diagram, one start of the command line, one solve watched by another process."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from tempfile import TemporaryDirectory

import numpy as np

from phframe.core import FloatArray
from phframe.registry import Kind, create

POINTS = 20
BARE_TYPER = """
import typer
app = typer.Typer()
@app.command()
def solve(scene: str = "basic") -> None: ...
@app.command()
def scenes() -> None: ...
app()
"""


def diagram_time(engine: str, repeats: int = 300) -> float:
    """Seconds for the persistence diagram of 20 points, the median of some."""
    points = np.random.default_rng(0).random((POINTS, 2))
    topology = create(Kind.TOPOLOGY, engine)
    return _median_time(lambda: topology.diagram(points), repeats)


def help_times(repeats: int = 7) -> tuple[float, float]:
    """Seconds for ``phframe --help`` and for the help of a bare typer program, the medians of some."""
    return _start_time(["-m", "phframe", "--help"], repeats), _start_time(["-c", BARE_TYPER, "--help"], repeats)


def solve_times(pairs: int = 15) -> FloatArray:
    """What it costs that a command carries a run out in a process that is watched.

    Returns:
        Seconds for ``phframe solve``, and for the same in the process that was started, in turn ``(pairs, 2)``.
    """
    watched, plain = "from phframe.cli.entry import main; main()", "from phframe.cli.main import app; app()"
    times = [[_solve_time(watched), _solve_time(plain)] for _ in range(pairs + 1)]
    return np.array(times[1:])  # the first ones load files


def _solve_time(code: str) -> float:
    with TemporaryDirectory() as folder:
        line = ("solve", "vieira/simple-07", "--no-rerun", "--quiet", "--out", f"{folder}/run")
        began = time.perf_counter()
        subprocess.run([sys.executable, "-P", "-c", code, *line], check=True, capture_output=True)
        return time.perf_counter() - began


def _start_time(arguments: Sequence[str], repeats: int) -> float:
    return _median_time(lambda: subprocess.run([sys.executable, *arguments], check=True, capture_output=True), repeats)


def _median_time(work: Callable[[], object], repeats: int) -> float:
    work()
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return float(np.median(times))
