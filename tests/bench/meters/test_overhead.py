"""The benchmark measures, prints tables and keeps the figures."""

from __future__ import annotations

import json
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pymunk
import pytest

from phframe.bench.meters import __main__ as bench
from phframe.bench.meters.overhead import Overhead, measure
from phframe.bench.meters.single import diagram_time, help_times

SCENES = ("vieira/simple-10", "papallas/s06")
BY_JOINTS = ("mujoco", "pinocchio", "coal", "ompl", "toppra")
"""What moving the Baxter by its joints needs."""


def test_one_scene_gives_figures_that_make_sense() -> None:
    step = pymunk.Space.step
    row = measure(SCENES[0])
    assert pymunk.Space.step is step, "pymunk is left as it was"
    assert row.scene == SCENES[0]
    for figure in (row.planning, row.bare, row.bare_stepped, row.ratio, row.strict_ratio):
        assert np.isfinite(figure)
        assert figure > 0.0
    assert 0 < row.stepped <= row.steps
    assert row.bare_stepped <= row.bare
    assert row.planning < 1.0
    assert measure(SCENES[0]).steps == row.steps


def test_ratios_are_of_planning_over_the_bare_loop() -> None:
    row = Overhead("x", planning=0.03, bare=0.02, bare_stepped=0.01, steps=200, stepped=100)
    assert [row.ratio, row.strict_ratio] == pytest.approx([1.5, 3.0])


@pytest.mark.parametrize("engine", ["ripser", "single-linkage"])
def test_one_diagram_takes_less_than_a_hundredth_of_a_second(engine: str) -> None:
    """A hundred times the bar that ``make bench`` measures."""
    assert 0.0 < diagram_time(engine, repeats=20) < 0.01


@pytest.mark.slow
def test_the_whole_benchmark_leaves_its_figures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bench, "scene_names", lambda: SCENES)
    monkeypatch.setattr(bench, "help_times", partial(help_times, 1))
    bench.main(["--planners", "phia", "--out", str(tmp_path / "new" / "bench.json")])
    figures = json.loads((tmp_path / "new" / "bench.json").read_text())
    moved = SCENES if all(map(find_spec, BY_JOINTS)) else ()
    always = {"suites", "overhead", "single", "simulation", "prediction"}
    assert set(figures) == always | ({"motion_planning"} if moved else set())
    assert [row["scene"] for row in figures.get("motion_planning", ())] == list(moved)
    assert [(row["suite"], row["scenes"], row["retrieved"]) for row in figures["suites"]] == [
        ("vieira", 1, 1),
        ("papallas", 1, 1),
        ("all", 2, 2),
    ]
    assert [row["scene"] for row in figures["overhead"]] == list(SCENES)
    assert all(value > 0.0 for value in figures["single"].values())
    printed = capsys.readouterr().out
    for word in ("phia on the published scenes", "PHIA planning", "Single figures", "In space", "figures: "):
        assert word in printed
