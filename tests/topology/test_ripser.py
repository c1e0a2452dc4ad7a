from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from phframe.core import Options
from phframe.topology.ripser_ import Ripser


def test_ripser_takes_neither_scikit_learn_nor_matplotlib_with_it() -> None:
    program = "import sys, phframe.topology.ripser_; print({'sklearn', 'matplotlib', 'scipy'} & set(sys.modules))"
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", program], cwd=root, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


@pytest.mark.slow
def test_the_compiled_module_gives_what_the_documented_function_gives() -> None:
    from ripser import ripser

    rng = np.random.default_rng(3)
    for n in (2, 3, 7, 20, 40):
        points = rng.uniform(0.0, 0.6, (n, 2)).round(2)
        distances = np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1))
        documented = ripser(distances, maxdim=0, distance_matrix=True)["dgms"][0]
        found = Ripser(Options()).diagram(points)
        np.testing.assert_array_equal(found.births, documented[:, 0])
        np.testing.assert_array_equal(found.deaths, np.sort(documented[:, 1]))


def test_one_diagram_of_twenty_points(benchmark: BenchmarkFixture) -> None:
    """The bound is 100 microseconds; `pytest --benchmark-only` shows the figure."""
    points = np.random.default_rng(0).uniform(0.0, 0.6, (20, 2))
    diagram = benchmark(Ripser(Options()).diagram, points)
    assert len(diagram.finite_deaths) == 19
