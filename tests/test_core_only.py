"""The core needs no library for 3D: it solves without them, and what does need them says in a line what to install."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.absence import DISTRIBUTIONS

ROOT = Path(__file__).resolve().parent.parent
ALL = tuple(DISTRIBUTIONS)
COMMAND = "from tests.absence import hide; hide({hidden!r}); from phframe.cli.main import main; main()"
PROBE = """
from importlib import import_module, metadata
from tests.absence import DISTRIBUTIONS, hide
hide(tuple(DISTRIBUTIONS))
for module, distribution in DISTRIBUTIONS.items():
    try:
        import_module(module)
    except ModuleNotFoundError:
        try:
            metadata.version(distribution)
        except metadata.PackageNotFoundError:
            print("hidden")
"""
REPLACED_FINDER = """
from importlib import metadata
from tests.absence import DISTRIBUTIONS, hide
hide(tuple(DISTRIBUTIONS))
import importlib_metadata
found = [name for name in DISTRIBUTIONS.values() if list(metadata.distributions(name=name))]
print(found, len(list(metadata.distributions(name="pytest"))))
"""
REPORT = (
    "import sys; from phframe import solve; print(solve('vieira/simple-07').status); "
    f"print(sorted({set(DISTRIBUTIONS)!r} & sys.modules.keys()))"
)


def python(code: str, *args: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code in a process of its own."""
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    return subprocess.run(
        [sys.executable, "-c", code, *args],
        cwd=folder, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


def phframe(line: str, folder: Path, hidden: Sequence[str] = ALL) -> subprocess.CompletedProcess[str]:
    """Run a command where some libraries are not installed."""
    return python(COMMAND.format(hidden=hidden), *line.split(), folder=folder)


def test_what_is_hidden_cannot_be_imported(tmp_path: Path) -> None:
    done = python(PROBE, folder=tmp_path)
    assert (done.returncode, done.stdout) == (0, "hidden\n" * len(DISTRIBUTIONS)), done.stderr


def test_a_library_that_replaces_the_finder_of_distributions_brings_nothing_back(tmp_path: Path) -> None:
    pytest.importorskip("importlib_metadata")
    done = python(REPLACED_FINDER, folder=tmp_path)
    assert (done.returncode, done.stdout) == (0, "[] 1\n"), done.stderr


def test_solving_imports_no_library_for_3d(tmp_path: Path) -> None:
    done = python(REPORT, folder=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "retrieved\n[]\n", "")


@pytest.mark.parametrize(
    "line", ["solve vieira/simple-07 --no-rerun --quiet", "backends", "arms", "export vieira/basic"]
)
def test_the_command_does_without_them(line: str, tmp_path: Path) -> None:
    done = phframe(line, tmp_path)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("line", "library", "extra"),
    [
        ("solve --backend mujoco", "mujoco", "mujoco"),
        ("solve --arm baxter", "pin", "baxter"),
        ("solve --backend mujoco --arm articulated", "mujoco", "mujoco"),
        ("solve --planner grtc-kinodynamic", "ompl", "ompl"),
        ("solve --video film.mp4", "av", "video"),
        ("scene import there.xml", "mujoco", "mujoco"),
        ("arm reach --arm baxter", "pin", "baxter"),
    ],
)
def test_what_needs_one_says_what_to_install(line: str, library: str, extra: str, tmp_path: Path) -> None:
    (tmp_path / "there.xml").write_text("<mujoco/>", "utf-8")
    done = phframe(line, tmp_path)
    check_lacks(done, library, extra)
    assert [path.name for path in tmp_path.iterdir()] == ["there.xml"]


def test_without_the_compiled_engine_all_is_planned_in_pymunk(tmp_path: Path) -> None:
    hidden = [*DISTRIBUTIONS, "numba"]
    solved = phframe("solve vieira/simple-07 --no-rerun", tmp_path, hidden)
    assert solved.returncode == 0, solved.stderr
    check_lacks(phframe("solve --backend fast", tmp_path, hidden), "numba", "fast")


@pytest.mark.needs_baxter
@pytest.mark.needs_mujoco
@pytest.mark.parametrize(("hidden", "extra"), [("ompl", "ompl"), ("toppra", "baxter")])
def test_joints_do_not_move_without_what_plans_their_motion(hidden: str, extra: str, tmp_path: Path) -> None:
    for module in ("mujoco", "pinocchio", "ompl", "toppra"):
        pytest.importorskip(module)
    done = phframe("solve --backend mujoco --arm articulated", tmp_path, [hidden])
    check_lacks(done, hidden, extra)
    assert not list(tmp_path.iterdir())


@pytest.mark.needs_video
def test_a_film_needs_what_draws_it(tmp_path: Path) -> None:
    pytest.importorskip("av")
    check_lacks(phframe("solve --video film.mp4", tmp_path, ["mujoco"]), "mujoco", "video")
    assert not list(tmp_path.iterdir())


def check_lacks(done: subprocess.CompletedProcess[str], library: str, extra: str) -> None:
    """Exit code 3, and one line with the library and the extra, or why there is no wheel here."""
    assert (done.returncode, done.stdout) == (3, ""), done.stderr
    assert done.stderr.count("\n") == 1
    assert f"needs {library}, which is not installed" in done.stderr
    assert f"phframe[{extra}]" in done.stderr or "no wheel" in done.stderr
