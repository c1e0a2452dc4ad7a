"""A leading tilde is the home in every flag and argument that names a file, also after an equals sign."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.cli.conftest import Invoke, invoke, workplace

__all__ = ["invoke", "workplace"]  # fixtures


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    folder.mkdir()
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.setenv("USERPROFILE", str(folder))
    return folder


def test_a_run_and_what_is_made_of_it_are_all_in_the_home(invoke: Invoke, workplace: Path, home: Path) -> None:
    scene = ["vieira/simple-07"]
    for arguments in (
        ["scenes", *scene, "--out=~/scene.yaml"],
        ["scenes", "~/scene.yaml", "--json"],
        ["solve", "~/scene.yaml", "--no-rerun", "--out=~/runs/first"],
        ["solve", *scene, "--no-rerun", "--out", "~/runs/second"],
        ["replay", "~/runs/first"],
        ["export", "~/scene.yaml", "--out=~/scene.xml"],
        ["export", "~/runs/first", "--format", "urdf-parts", "--out=~/parts"],
        ["bench", "run", *scene, "--planner", "phia", "--out=~/bench", "--quiet"],
        ["bench", "export", "~/bench", "--out=~/bench.csv"],
        ["report", "~/bench", "--out=~/report.html", "--markdown=~/report.md"],
    ):
        result = invoke(*arguments)
        assert result.exit_code == 0, (arguments, result.output)
    made = {"scene.yaml", "scene.xml", "runs", "parts", "bench", "bench.csv", "report.html", "report.md"}
    assert made == {
        each.name for each in home.iterdir() if not each.name.startswith(".")
    }  # libraries keep caches there
    assert sorted(each.name for each in (home / "runs" / "first").iterdir()) == ["episode.json", "summary.json"]
    assert list(workplace.iterdir()) == []


@pytest.mark.needs_baxter
def test_files_in_options_are_too(invoke: Invoke, home: Path) -> None:
    for library in ("pinocchio", "ompl", "toppra", "coal"):
        pytest.importorskip(library)
    from phframe.arms.articulated import EXAMPLE

    shutil.copytree(EXAMPLE.parent, home / "arm")
    chosen = ["--arm", "articulated", "--option", "arm.description=~/arm/arm.yaml", "--format", "urdf-parts"]
    result = invoke("export", "vieira/basic", *chosen, "--out=~/parts")
    assert result.exit_code == 0, result.output
    assert (home / "parts" / "arm.urdf").is_file()


@pytest.mark.parametrize("name", ["film.jpg", "film", "film.txt", "-"])
def test_a_suffix_that_is_no_films_is_refused(invoke: Invoke, workplace: Path, name: str) -> None:
    result = invoke("solve", "vieira/simple-07", "--no-rerun", "--video", name)
    assert result.exit_code in (2, 3)
    assert result.stderr.count("\n") == 1
    assert list(workplace.iterdir()) == []
